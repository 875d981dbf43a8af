//! The words behind `:plot`.

/// What is drawn with a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Aids {
    /// Its curvature, as a comb on its normals.
    pub comb: bool,
    /// Its control polygon.
    pub polygon: bool,
    /// De Casteljau's construction at this parameter.
    pub blossom: Option<f64>,
}

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// A list of what is plotted and the numbers behind it, with blanks before it so that its columns are those of the line.
    pub expression: String,
    /// The line, for diagnostics: its bytes stand at the same offsets.
    pub line: String,
    /// What a person wrote.
    pub title: String,
    /// The lobe of a material, not a curve.
    pub lobe: bool,
    /// What is drawn with it.
    pub aids: Aids,
}

impl Request {
    /// Reads `EXPR[, FROM, TO] [comb] [polygon] [blossom T]` or `brdf MATERIAL[, DEGREES]`, which ends a line after `before` bytes of it.
    /// Errors are sentences.
    pub fn parse(line: &str, before: usize) -> Result<Request, String> {
        let mut rest = line[before..].trim_end();
        let mut aids = Aids::default();
        while let Some((more, word)) = rest.rsplit_once(char::is_whitespace) {
            match (word, more.trim_end().rsplit_once(char::is_whitespace)) {
                ("comb", _) => aids.comb = true,
                ("polygon", _) => aids.polygon = true,
                (t, Some((more, "blossom"))) => {
                    let t: f64 = t.parse().map_err(|_| format!("`blossom` wants a number, and not `{t}`"))?;
                    aids.blossom = Some(t);
                    rest = more.trim_end();
                    continue;
                }
                _ => break,
            }
            rest = more.trim_end();
        }
        let title = rest.trim().to_owned();
        let word = rest.trim_start().strip_prefix("brdf").filter(|after| after.starts_with(' '));
        let written = word.unwrap_or(rest);
        if written.trim().is_empty() {
            return Err("there is nothing to plot: write `:plot x => sin(x), 0, 6.28` or `:plot path`".into());
        }
        // The bracket takes the place of the blank or letter before what was written. Where a bracket too many ends it, none is
        // put around it, so that the fault is told of the one that was written.
        let column = before + rest.len() - written.trim_start().len();
        let n_of = |bracket: char| written.matches(bracket).count();
        let (open, close) = if n_of(']') > n_of('[') { (" ", "") } else { ("[", "]") };
        let expression = format!("{}{open}{}{close}", " ".repeat(column.saturating_sub(1)), written.trim());
        Ok(Request { expression, line: format!("{} ", line.trim_end()), title, lobe: word.is_some(), aids })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn aids_follow_what_is_plotted() {
        let parse = |text: &str| Request::parse(text, 6).unwrap();
        let plain = parse(":plot x => sin(x), 0, 6.28");
        assert_eq!(plain.expression, "     [x => sin(x), 0, 6.28]");
        assert_eq!((plain.title.as_str(), plain.aids), ("x => sin(x), 0, 6.28", Aids::default()));
        let all = parse(":plot path comb blossom 0.25 polygon");
        assert_eq!(all.aids, Aids { comb: true, polygon: true, blossom: Some(0.25) });
        assert_eq!(all.title, "path");
        let lobe = parse(":plot brdf clay, 30");
        assert_eq!((lobe.lobe, lobe.expression.as_str()), (true, "          [clay, 30]"));
        assert_eq!(parse(":plot comb").title, "comb");
        assert_eq!(parse(":plot x => x]").expression, "      x => x]");
    }

    #[test]
    fn a_plot_of_nothing_is_told() {
        assert!(Request::parse(":plot", 5).is_err() && Request::parse(":plot brdf ", 6).is_ok());
        assert!(Request::parse(":plot path blossom half", 6).unwrap_err().contains("half"));
    }
}
