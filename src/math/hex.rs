//! Numbers as hexadecimal floats, `-0x1.8p+1`: exact, and short for round numbers. The form of C's `%a` and of Python's `float.hex`.

/// The number, exactly. Infinities and NaN in words.
pub fn hex(x: f64) -> String {
    if !x.is_finite() {
        return x.to_string();
    }
    let bits = x.to_bits();
    let sign = if bits >> 63 == 1 { "-" } else { "" };
    let (exponent, fraction) = ((bits >> 52 & 0x7ff) as i64, bits & ((1 << 52) - 1));
    if exponent == 0 && fraction == 0 {
        return format!("{sign}0x0p+0");
    }
    let (lead, exponent) = if exponent == 0 { (0, -1022) } else { (1, exponent - 1023) };
    let digits = format!("{fraction:013x}");
    let digits = digits.trim_end_matches('0');
    let point = if digits.is_empty() { "" } else { "." };
    format!("{sign}0x{lead}{point}{digits}p{exponent:+}")
}

/// Many numbers, separated by blanks.
pub fn hex_list(numbers: &[f64]) -> String {
    numbers.iter().map(|&x| hex(x)).collect::<Vec<_>>().join(" ")
}

/// The number back from its text; infinities and NaN too. None where the text is not of this form, has more than 16 digits or
/// stands for a number beyond the range of f64.
pub fn parse_hex(text: &str) -> Option<f64> {
    let (sign, rest) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let Some(rest) = rest.strip_prefix("0x") else {
        return matches!(rest, "inf" | "NaN").then(|| text.parse().ok()).flatten();
    };
    let (digits, exponent) = rest.split_once('p')?;
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let mantissa = u64::from_str_radix(&format!("{whole}{fraction}"), 16).ok()? as f64;
    let exponent = exponent.parse::<i32>().ok()?.checked_sub(4 * fraction.len() as i32)?;
    let x = sign * super::exact::scale_by(mantissa, exponent.clamp(-2000, 2000));
    x.is_finite().then_some(x)
}

/// Numbers separated by blanks; None where one of them is none.
pub fn parse_hex_list(text: &str) -> Option<Vec<f64>> {
    text.split_whitespace().map(parse_hex).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_floats_are_exact_both_ways() {
        for (x, text) in [
            (1.0, "0x1p+0"),
            (-3.0, "-0x1.8p+1"),
            (0.1, "0x1.999999999999ap-4"),
            (0.0, "0x0p+0"),
            (5e-324, "0x0.0000000000001p-1022"),
            (f64::MAX, "0x1.fffffffffffffp+1023"),
        ] {
            assert_eq!(hex(x), text);
            assert_eq!(parse_hex(text), Some(x));
        }
        assert_eq!(parse_hex("0x1.0000000000000p+0"), Some(1.0));
        assert_eq!(parse_hex("-inf"), Some(f64::NEG_INFINITY));
        assert_eq!((parse_hex("0.5"), parse_hex("0x1"), parse_hex("0x1p+5000")), (None, None, None));
        assert_eq!(parse_hex_list(&hex_list(&[0.3, -7.0])), Some(vec![0.3, -7.0]));
    }
}
