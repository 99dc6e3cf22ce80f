use super::*;
use nalgebra::DVector;
use trial::{Channel, Columns, RecordOrigin, Trial};

fn record(time: &[f64]) -> PreparedRecord {
    let wave = |scale: f64| time.iter().map(|t| scale * (0.05 * t).sin()).collect::<Vec<_>>();
    let channels = [(Channel::Heading, wave(0.2)), (Channel::Rudder, wave(0.1))].into();
    let origin = RecordOrigin::Simulated { scenario: "noise".into(), cell: 0, replicate: 0 };
    let columns = Columns { time: time.to_vec(), channels, unknown_columns: Vec::new() };
    PreparedRecord::unaveraged(&Trial::new("noise", origin, columns).expect("a valid record"))
}

/// Covariance of the heading under a random moment and waves, summed over small steps.
fn covariance(time: &[f64], a: f64, colour: &NoiseColour, longest: f64) -> DMatrix<f64> {
    let n = time.len();
    let mut total = DMatrix::identity(n, n);
    if let Some((kind @ CorrelatedNoise::CompassError(_), level)) = colour.correlated {
        let tau = kind.correlation_time(longest).expect("an error that lasts");
        total += DMatrix::from_fn(n, n, |i, j| level * (-(time[i] - time[j]).abs() / tau).exp());
    } else if let Some((kind, level)) = colour.correlated {
        // Heading after a unit impulse of yaw acceleration, after a unit step, and after a decaying step.
        let faded = |rate: f64, t: f64| (1.0 - (-rate * t).exp()) / rate;
        let tau = kind.correlation_time(longest).unwrap_or(f64::NAN);
        let impulse = |a: f64, t: f64| match kind {
            CorrelatedNoise::WhiteMoment => faded(a, t),
            CorrelatedNoise::OrnsteinUhlenbeck(_) => (faded(tau.recip(), t) - faded(a, t)) / (a - tau.recip()),
            _ => (t - faded(a, t)) / a,
        };
        let white = 3.0 / longest.powi(3);
        let intensity = match kind {
            CorrelatedNoise::WhiteMoment => white,
            CorrelatedNoise::OrnsteinUhlenbeck(_) => white / (tau * tau),
            _ => 20.0 / longest.powi(5),
        };
        if kind.correlation_time(longest).is_some() {
            // Stationary gusts.
            let g = DVector::from_fn(n, |i, _| impulse(a, time[i] - time[0]));
            total += &g * g.transpose() * (0.5 * level * intensity * tau);
        }
        let (first, h) = (time[0], 0.02);
        let steps = ((time[n - 1] - first) / h).round() as usize;
        for k in 0..steps {
            let at = first + (k as f64 + 0.5) * h;
            let g = DVector::from_fn(n, |i, _| if time[i] > at { impulse(a, time[i] - at) } else { 0.0 });
            total += &g * g.transpose() * (level * intensity * h);
        }
    }
    if let Some(waves) = colour.waves {
        let (w, z) = (waves.frequency, waves.damping);
        let wd = w * (1.0 - z * z).sqrt();
        for i in 0..n {
            for j in 0..n {
                let t = (time[i] - time[j]).abs();
                let rho = (-z * w * t).exp() * ((wd * t).cos() + z * w / wd * (wd * t).sin());
                total[(i, j)] += waves.sd * waves.sd * rho;
            }
        }
    }
    total
}

/// The filter gives the likelihood of the dense covariance: Σ log S is its log determinant and the whitened square its
/// quadratic form, on even and uneven rows.
#[test]
fn whitening_is_the_inverse_root_of_the_covariance() {
    let even: Vec<f64> = (0..40).map(f64::from).collect();
    let uneven: Vec<f64> = (0..40).map(|k| f64::from(k) + 0.3 * f64::from(k % 3)).collect();
    let waves = NarrowBandProcess { sd: 2.0, frequency: 0.6, damping: 0.1 };
    for time in [even, uneven] {
        let record = record(&time);
        let longest = record.duration();
        let a = 0.08;
        let noise = RecordNoise::new(&record, a, longest, 1);
        let colours = [
            NoiseColour { correlated: Some((CorrelatedNoise::WhiteMoment, 50.0)), waves: None },
            NoiseColour { correlated: Some((CorrelatedNoise::WalkMoment, 400.0)), waves: None },
            NoiseColour { correlated: Some((CorrelatedNoise::OrnsteinUhlenbeck(2), 80.0)), waves: None },
            NoiseColour { correlated: Some((CorrelatedNoise::CompassError(3), 9.0)), waves: None },
            NoiseColour { correlated: Some((CorrelatedNoise::CompassError(2), 2.0)), waves: Some(waves) },
            NoiseColour { correlated: None, waves: Some(waves) },
            NoiseColour { correlated: Some((CorrelatedNoise::WalkMoment, 100.0)), waves: Some(waves) },
        ];
        for colour in colours {
            let dense = covariance(&time, a, &colour, longest).cholesky().expect("positive definite");
            let whitener = noise.whitener(&colour);
            let log_determinant = 2.0 * dense.l().diagonal().iter().map(|d| d.ln()).sum::<f64>();
            assert!(
                (whitener.log_determinant - log_determinant).abs() < 2e-3 * log_determinant.abs().max(1.0),
                "{colour:?}: {} is not {log_determinant}",
                whitener.log_determinant
            );
            let y = DVector::from_fn(time.len(), |i, _| (0.7 * i as f64).sin() + 0.1 * i as f64);
            let mut white: Vec<f64> = y.iter().copied().collect();
            whitener.apply(&mut [&mut white]);
            let square: f64 = white.iter().map(|x| x * x).sum();
            let quadratic = y.dot(&dense.solve(&y));
            assert!((square / quadratic - 1.0).abs() < 2e-3, "{colour:?}: {square} is not {quadratic}");
        }
    }
}

/// A row with a quarter of the readings has twice the standard deviation and half the weight, under any colour.
#[test]
fn rows_count_by_their_readings() {
    let time: Vec<f64> = (0..20).map(f64::from).collect();
    let mut record = record(&time);
    record.row_readings.fill(4);
    record.row_readings[7] = 1;
    let noise = RecordNoise::new(&record, 0.1, 19.0, 4);
    for colour in
        [NoiseColour::WHITE, NoiseColour { correlated: Some((CorrelatedNoise::WhiteMoment, 1e-12)), waves: None }]
    {
        let whitener = noise.whitener(&colour);
        let mut column = vec![1.0; 20];
        whitener.apply(&mut [&mut column]);
        assert!((column[7] - 0.5).abs() < 1e-9 && (column[8] - 1.0).abs() < 1e-9, "{colour:?}: {column:?}");
        assert!((whitener.log_determinant - 4f64.ln()).abs() < 1e-9);
    }
}

#[test]
fn white_noise_is_left_alone() {
    let time: Vec<f64> = (0..20).map(f64::from).collect();
    let whitener = RecordNoise::new(&record(&time), 0.1, 19.0, 1).whitener(&NoiseColour::WHITE);
    let mut column: Vec<f64> = time.clone();
    whitener.apply(&mut [&mut column]);
    assert_eq!((column, whitener.log_determinant), (time, 0.0));
}
