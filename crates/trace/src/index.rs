//! Places and numbers that must not be mixed up: a term is not a candidate, nor is either a record.

/// Number of a record among those that are analysed together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RecordNumber(pub usize);

/// Place of a term in a structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TermPlace(pub usize);

/// Place of a candidate in the list of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct CandidatePlace(pub usize);

/// Place of a parameter in θ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct ThetaPlace(pub usize);
