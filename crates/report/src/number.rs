//! Numbers for tables and axes: a true minus sign, as many digits as the uncertainty supports, a dash for an undefined
//! value. All functions are pure; none rounds a value that is used again.

/// Text for an undefined value.
pub const MISSING: &str = "–";

/// Range of magnitudes written without a power of ten.
const PLAIN: std::ops::Range<f64> = 1e-4..1e6;

/// Maximum number of decimals: a double has about 15 significant digits.
const MAX_DECIMALS: i32 = 15;

/// Approximate width of a 95 % interval in standard deviations.
const INTERVAL_95_WIDTH_SD: f64 = 4.0;

/// Count with a noun of regular plural, such as "1 record" and "2 records".
pub fn counted(count: u64, word: &str) -> String {
    format!("{count} {word}{}", if count == 1 { "" } else { "s" })
}

/// `value` with `decimals` decimals, a true minus sign and no negative zero; [`MISSING`] if it is not finite.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return MISSING.into();
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|b| matches!(b, b'0' | b'.')) => digits.into(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// `value` with `digits` significant digits, and with a power of ten if its magnitude is below 1e-4 or from 1e6 on;
/// [`MISSING`] if it is not finite.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return MISSING.into();
    }
    let digits = digits.max(1);
    if value == 0.0 || PLAIN.contains(&value.abs()) {
        return fixed(value, decimals_for(value, digits));
    }
    let text = format!("{:.*e}", digits - 1, value);
    let (mantissa, exponent) = text.split_once('e').expect("the exponent format always has an e");
    let exponent: i32 = exponent.parse().expect("the exponent format ends in an integer");
    format!("{}×{}", mantissa.replace('-', "−"), power_of_ten(exponent))
}

/// `0.1003 ± 0.0007`: the uncertainty with one significant digit (two if it starts with 1 or 2 or would round up to 10,
/// for which one digit is too coarse), the value to the same decimal.
///
/// Without a finite positive uncertainty the value is alone, with five significant digits. Numbers have at most 15
/// decimals.
pub fn with_uncertainty(value: f64, sd: Option<f64>) -> String {
    match sd.filter(|sd| sd.is_finite() && *sd > 0.0) {
        Some(sd) if value.is_finite() => {
            let decimals = decimals_of_uncertainty(sd);
            format!("{} ± {}", fixed(value, decimals), fixed(sd, decimals))
        }
        _ => significant(value, 5),
    }
}

/// `(1.23 ± 0.04)×10⁻⁵` for a magnitude below 0.001 or from 100,000 on, unless it is zero; otherwise as
/// [`with_uncertainty`].
pub fn with_uncertainty_and_power(value: f64, sd: Option<f64>) -> String {
    if value != 0.0 && value.is_finite() && !(1e-3..1e5).contains(&value.abs()) {
        let exponent = value.abs().log10().floor() as i32;
        let unit = 10f64.powi(exponent);
        let number = with_uncertainty(value / unit, sd.map(|sd| sd / unit));
        return format!("({number})×{}", power_of_ten(exponent));
    }
    with_uncertainty(value, sd)
}

/// `[0.0989, 0.1017]`: both ends to the decimal that their distance supports; [`MISSING`] without a finite interval.
pub fn interval(bounds: Option<[f64; 2]>) -> String {
    match bounds {
        Some([lo, hi]) if lo.is_finite() && hi.is_finite() => {
            let sd = (hi - lo).abs() / INTERVAL_95_WIDTH_SD;
            let decimals = if sd > 0.0 { decimals_of_uncertainty(sd) } else { decimals_for(lo, 5) };
            format!("[{}, {}]", fixed(lo, decimals), fixed(hi, decimals))
        }
        _ => MISSING.into(),
    }
}

/// `value` with as many decimals as [`interval`] gives the ends of its interval; four significant digits without an
/// interval of positive length.
pub fn with_supported_digits(value: f64, bounds: Option<[f64; 2]>) -> String {
    match bounds.map(|[lo, hi]| (hi - lo) / INTERVAL_95_WIDTH_SD) {
        Some(sd) if sd.is_finite() && sd > 0.0 => fixed(value, decimals_of_uncertainty(sd)),
        _ => significant(value, 4),
    }
}

/// `value` with `decimals` decimals; [`MISSING`] for `None` or a value that is not finite.
pub fn optional(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| MISSING.into(), |v| fixed(v, decimals))
}

/// `10⁻³` for −3.
pub fn power_of_ten(exponent: i32) -> String {
    let superscript = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).expect("⁰ and ⁴ to ⁹ are consecutive"),
    };
    let digits: String = exponent.to_string().chars().map(superscript).collect();
    format!("10{digits}")
}

/// Decimals that show `digits` significant digits of `value`.
fn decimals_for(value: f64, digits: usize) -> usize {
    if value == 0.0 {
        return 0;
    }
    let exponent = exponent(value, digits);
    (digits as i32 - 1 - exponent).clamp(0, MAX_DECIMALS) as usize
}

/// Decimals that show an uncertainty with one digit, or with two if that digit would be a 1 or a 2 or round up to 10.
fn decimals_of_uncertainty(sd: f64) -> usize {
    let leading = sd / 10f64.powi(exponent(sd, 2));
    decimals_for(sd, if (2.95..9.5).contains(&leading) { 1 } else { 2 })
}

/// Power of ten of the leading digit after rounding to `digits`, so that 0.0999 with two digits counts as 0.10.
fn exponent(value: f64, digits: usize) -> i32 {
    let text = format!("{:.*e}", digits - 1, value);
    text.split_once('e').and_then(|(_, e)| e.parse().ok()).expect("the exponent format ends in an integer")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_of_any_size_has_its_power_of_ten() {
        assert_eq!(with_uncertainty_and_power(1.234e-5, Some(4e-7)), "(1.23 ± 0.04)×10⁻⁵");
        assert_eq!(with_uncertainty_and_power(0.1, Some(0.01)), with_uncertainty(0.1, Some(0.01)));
        assert_eq!(with_uncertainty_and_power(f64::INFINITY, None), with_uncertainty(f64::INFINITY, None));
    }

    #[test]
    fn digits_follow_the_uncertainty() {
        assert_eq!(with_uncertainty(0.100_312, Some(0.000_71)), "0.1003 ± 0.0007");
        assert_eq!(with_uncertainty(18.0321, Some(0.234)), "18.03 ± 0.23");
        assert_eq!(with_uncertainty(-0.5, Some(0.099)), "−0.500 ± 0.099");
        assert_eq!(with_uncertainty(1234.5, Some(56.0)), "1234 ± 56");
        assert_eq!(with_uncertainty(0.1003, None), "0.10030");
        assert_eq!(with_uncertainty(0.1003, Some(0.0)), "0.10030");
        assert_eq!(with_uncertainty(f64::NAN, Some(1.0)), "–");
    }

    #[test]
    fn intervals_and_missing() {
        assert_eq!(interval(Some([0.098_91, 0.101_69])), "[0.0989, 0.1017]");
        assert_eq!(interval(Some([1.0, 1.0])), "[1.0000, 1.0000]");
        assert_eq!(interval(None), "–");
        assert_eq!(interval(Some([f64::NAN, 1.0])), "–");
        assert_eq!(with_supported_digits(0.078_12, Some([0.077_79, 0.078_45])), "0.07812");
        assert_eq!(with_supported_digits(0.003, Some([-0.2, 0.2])), "0.00");
        assert_eq!(with_supported_digits(0.078_12, Some([0.5, 0.5])), "0.07812");
        assert_eq!(with_supported_digits(0.078_12, None), "0.07812");
        assert_eq!(optional(None, 2), "–");
        assert_eq!(optional(Some(-1.005), 1), "−1.0");
    }

    #[test]
    fn no_negative_zero_and_powers_of_ten() {
        assert_eq!(fixed(-0.001, 2), "0.00");
        assert_eq!(significant(-1.234e-7, 3), "−1.23×10⁻⁷");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(significant(12_345.0, 3), "12345");
        assert_eq!(power_of_ten(-10), "10⁻¹⁰");
        assert_eq!(power_of_ten(456), "10⁴⁵⁶");
    }
}
