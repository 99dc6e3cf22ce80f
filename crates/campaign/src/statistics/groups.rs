//! Things of one kind together.

/// Groups in the order of their first members.
pub fn grouped<K: PartialEq, T>(all: impl IntoIterator<Item = T>, key: impl Fn(&T) -> K) -> Vec<(K, Vec<T>)> {
    let mut found: Vec<(K, Vec<T>)> = Vec::new();
    for one in all {
        let own = key(&one);
        match found.iter_mut().find(|(known, _)| *known == own) {
            Some((_, group)) => group.push(one),
            None => found.push((own, vec![one])),
        }
    }
    found
}

/// Every one once, in the order in which they came.
pub fn distinct<T: PartialEq>(all: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut found: Vec<T> = Vec::new();
    for one in all {
        if !found.contains(&one) {
            found.push(one);
        }
    }
    found
}
