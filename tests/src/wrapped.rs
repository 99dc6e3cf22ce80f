//! Tables whose directions were interpolated across north: between 359° and 1° stands 180°.

/// Difference, deg, between two rows from which a direction has passed north: no ship turns so fast.
const JUMP: f64 = 60.0;

/// The same table with empty cells in a column of directions, deg, on either side of every jump.
pub fn without_jumps(text: &str, column: &str) -> String {
    let mut rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let Some(place) = rows.first().and_then(|head| head.iter().position(|name| *name == column)) else {
        return text.to_owned();
    };
    let direction = |row: &Vec<&str>| row.get(place).and_then(|cell| cell.parse::<f64>().ok());
    let directions: Vec<Option<f64>> = rows.iter().map(direction).collect();
    for (before, pair) in directions.windows(2).enumerate() {
        let [Some(one), Some(two)] = *pair else { continue };
        if (two - one).abs() > JUMP {
            rows[before][place] = "";
            rows[before + 1][place] = "";
        }
    }
    rows.iter().map(|row| row.join(",") + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::without_jumps;

    #[test]
    fn both_sides_of_a_jump_are_empty() {
        let table = "t_s,psi\n0,350\n1,355\n2,180\n3,5\n4,10\n";
        assert_eq!(without_jumps(table, "psi"), "t_s,psi\n0,350\n1,\n2,\n3,\n4,10\n");
        assert_eq!(without_jumps(table, "heading"), table);
    }
}
