//! The methods of the project by name, with their settings as they are written in scenario files.
