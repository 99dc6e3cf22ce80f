//! Outside estimators as the command line names them: `LABEL=COMMAND`.

use std::path::Path;
use std::str::FromStr;

use identify::external::Settings;
use identify::{Identifier, Outside};
use scenario::failure::Failure;
use scenario::name;

/// A label and a command, such as `mine=python3 "my estimator.py"`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedCommand {
    /// What the method is called.
    pub label: String,
    /// The program and its arguments.
    pub command: Vec<String>,
}

impl FromStr for NamedCommand {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || "expected LABEL=COMMAND, for instance mine=\"python3 mine.py\"".to_owned();
        let (label, command) = text.split_once('=').ok_or_else(expected)?;
        name::label(label).map_err(|unfit| format!("the label: {unfit}"))?;
        let command = words(command)?;
        if command.is_empty() { Err(expected()) } else { Ok(Self { label: label.to_owned(), command }) }
    }
}

/// The words of a command: blanks part them, except between two quotes of one kind.
fn words(command: &str) -> Result<Vec<String>, String> {
    let mut words: Vec<String> = Vec::new();
    let mut word: Option<String> = None;
    let mut letters = command.chars();
    while let Some(letter) = letters.next() {
        match letter {
            '\'' | '"' => {
                let word = word.get_or_insert_default();
                loop {
                    match letters.next() {
                        Some(next) if next == letter => break,
                        Some(next) => word.push(next),
                        None => return Err(format!("the command has a quote {letter} without its end")),
                    }
                }
            }
            blank if blank.is_whitespace() => words.extend(word.take()),
            letter => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    Ok(words)
}

/// A method with what it is called.
pub type Named = (String, Box<dyn Identifier>);

/// What is said of a label that another method has.
pub const SAME_LABEL: &str = "there is another method with this label; give it one of its own";

/// The methods of these commands with their labels; programs run where this one does. Nothing is started yet.
///
/// Fails when two methods have one label, those that are `known` included, when a command cannot be one, and when its
/// program or script is not there.
pub fn methods(commands: &[NamedCommand], known: &[&str]) -> Result<Vec<Named>, Failure> {
    let mut methods: Vec<Named> = Vec::new();
    for NamedCommand { label, command } in commands {
        let refuse = |problem: &dyn std::fmt::Display| Failure::input(format!("--external {label}=…: {problem}"));
        if known.contains(&label.as_str()) || methods.iter().any(|(other, _)| other == label) {
            return Err(refuse(&SAME_LABEL));
        }
        let method = Settings::new(command).build(Path::new("")).map_err(|error| refuse(&error))?;
        method.outside().map_or(Ok(()), Outside::find).map_err(|problem| refuse(&problem))?;
        methods.push((label.clone(), Box::new(method)));
    }
    Ok(methods)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_words_and_quotes_keep_blanks() {
        let read = |text: &str| text.parse::<NamedCommand>().map(|own| (own.label, own.command.join("|")));
        for (text, label, command) in [
            ("mine=python3 mine.py", "mine", "python3|mine.py"),
            ("a b=  'my program'  -x=1 \"\" it's 'me ", "a b", "my program|-x=1||its me"),
        ] {
            assert_eq!(read(text), Ok((label.to_owned(), command.to_owned())));
        }
        for (text, part) in
            [("python3", "LABEL=COMMAND"), ("=python3", "label"), ("a= ", "LABEL=COMMAND"), ("a='b", "quote '")]
        {
            let error = read(text).expect_err(text);
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn labels_are_told_apart() {
        let named = |label: &str, program: &str| NamedCommand { label: label.into(), command: vec![program.into()] };
        let refused = |commands: &[NamedCommand]| methods(commands, &["srivc"]).err().expect("refused").message;
        assert!(refused(&[named("srivc", "cargo")]).contains("--external srivc=…: there is another method"));
        assert!(refused(&[named("a", "cargo"), named("a", "cargo")]).contains("another method"));
        assert!(refused(&[named("a", "no-such-program-here")]).contains("on the PATH"));
        assert!(refused(&[named("a", "")]).contains("command"));
    }
}
