//! Numbers as command-line arguments, refused in words.

/// A finite number.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err("expected a finite number".to_owned()),
        Err(_) => Err("expected a number".to_owned()),
    }
}

/// A finite number above zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match finite(text) {
        Ok(value) if value > 0.0 => Ok(value),
        _ => Err("expected a number above zero".to_owned()),
    }
}

/// Seconds from zero on.
pub(crate) fn secs(text: &str) -> Result<f64, String> {
    match finite(text) {
        Ok(value) if value >= 0.0 => Ok(value),
        _ => Err("expected seconds, zero or more".to_owned()),
    }
}

/// A number as people read it: six significant digits at most, no noise behind them.
pub(crate) fn short(value: f64) -> String {
    significant(value, 6)
}

/// A number with at most so many significant digits, no zeros behind them.
pub(crate) fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let decimals = digits - 1 - value.abs().log10().floor() as i32;
    if !(0..=digits + 6).contains(&decimals) {
        return format!("{value:.*e}", digits.max(1) as usize - 1);
    }
    let text = format!("{value:.*}", decimals as usize);
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_without_noise() {
        for (value, expected) in [
            (0.0, "0"),
            (-0.0, "0"),
            (0.1 + 0.2, "0.3"),
            (1.0, "1"),
            (-12.5, "-12.5"),
            (123_456.0, "123456"),
            (1.0 / 3.0, "0.333333"),
            (1e-9, "1.00000e-9"),
            (1.5e9, "1.50000e9"),
        ] {
            assert_eq!(short(value), expected, "{value}");
        }
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for text in ["", "x", "nan", "inf", "-inf", "1e999"] {
            assert!(finite(text).is_err(), "{text}");
        }
        assert!(positive("0").is_err());
        assert!(secs("-0.1").is_err());
        assert_eq!(secs("0"), Ok(0.0));
    }
}
