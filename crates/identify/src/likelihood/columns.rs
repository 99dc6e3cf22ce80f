//! Columns of heading and yaw rate whose linear combinations are the first-order responses for one 1/T.

/// Responses φ₁, G and H of the heading at the observed rows, and their time derivatives at the rows with a yaw rate.
/// The constant column of the heading is left out.
#[derive(Debug, Clone, Default)]
pub struct MotionColumns {
    /// Response φ₁(t − t₁) to the yaw rate at the anchor t₁, s.
    pub homogeneous: Vec<f64>,
    /// Response G to the rudder, divided by b = K/T, rad s².
    pub rudder: Vec<f64>,
    /// Response H to a constant yaw acceleration, s².
    pub constant: Vec<f64>,
    /// Columns of the yaw rate, at the rows where it is used.
    pub rates: RateColumns,
}

impl MotionColumns {
    /// Columns of the heading: φ₁, G and H.
    pub fn headings(&self) -> [&[f64]; 3] {
        [&self.homogeneous, &self.rudder, &self.constant]
    }

    fn headings_mut(&mut self) -> [&mut Vec<f64>; 3] {
        [&mut self.homogeneous, &mut self.rudder, &mut self.constant]
    }

    /// Sets all columns to zero; `rate` is the row of the anchor and the homogeneous yaw rate there, `None` without yaw
    /// rates.
    pub(super) fn reset(&mut self, rows: usize, rate: Option<(usize, f64)>) {
        self.headings_mut().into_iter().for_each(|column| *column = vec![0.0; rows]);
        if let Some((anchor, rate)) = rate {
            self.rates.all_mut().into_iter().for_each(|column| *column = vec![0.0; rows]);
            self.rates.homogeneous[anchor] = rate;
        }
    }

    /// Keeps the rows with a heading and those with a yaw rate.
    pub(super) fn keep(&mut self, headings: &[usize], rates: &[usize]) {
        self.headings_mut().into_iter().for_each(|column| keep(headings, column));
        self.rates.all_mut().into_iter().for_each(|column| keep(rates, column));
    }

    /// Columns of φ₁, G and H: of the heading, and of the yaw rate.
    pub(super) fn slices(&mut self) -> ([&mut [f64]; 3], [&mut [f64]; 3]) {
        let Self { homogeneous, rudder, constant, rates } = self;
        ([homogeneous, rudder, constant].map(Vec::as_mut_slice), rates.all_mut().map(Vec::as_mut_slice))
    }
}

impl RateColumns {
    /// Columns of the yaw rate: φ₁', G' and H'.
    pub fn yaw_rates(&self) -> [&[f64]; 3] {
        [&self.homogeneous, &self.rudder, &self.constant]
    }

    fn all_mut(&mut self) -> [&mut Vec<f64>; 3] {
        [&mut self.homogeneous, &mut self.rudder, &mut self.constant]
    }
}

/// Columns of the yaw rate, the time derivatives of the heading columns.
#[derive(Debug, Clone, Default)]
pub struct RateColumns {
    /// Response φ₁' = exp(−a (t − t₁)) to the yaw rate at the anchor t₁, dimensionless.
    pub homogeneous: Vec<f64>,
    /// Response G' to the rudder, divided by b = K/T, rad s.
    pub rudder: Vec<f64>,
    /// Response H' to a constant yaw acceleration, s.
    pub constant: Vec<f64>,
}

/// Keeps the given rows of a column that was filled in every row.
pub(super) fn keep(rows: &[usize], column: &mut Vec<f64>) {
    if rows.len() < column.len() {
        for (place, &row) in rows.iter().enumerate() {
            column[place] = column[row];
        }
        column.truncate(rows.len());
    }
}
