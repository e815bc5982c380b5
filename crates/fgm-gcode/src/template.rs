//! Start and end G-code with `{variables}`.

use crate::{GcodeError, Templates};

/// Every variable a template may use, with what it stands for.
pub const VARIABLES: [(&str, &str); 13] = [
    ("printer", "the profile's name"),
    ("nozzle_temperature", "the nozzle's on the first layer in the first colour, °C"),
    ("bed_temperature", "the bed's on the first layer, °C"),
    ("standby_temperature", "an idle head's, °C"),
    ("initial_tool", "the head of the first colour, from 0"),
    ("initial_state", "the commands that set the first colour"),
    ("nozzle", "the nozzle's diameter, mm"),
    ("bed_min_x", "least x of the bed, mm"),
    ("bed_min_y", "least y of the bed, mm"),
    ("bed_max_x", "greatest x of the bed, mm"),
    ("bed_max_y", "greatest y of the bed, mm"),
    ("max_z", "the height reached, mm; end template only"),
    ("park_z", "10 mm above that, or the machine's height, mm; end template only"),
];

/// Whether both templates have known variables only.
pub(crate) fn check(templates: &Templates) -> Result<(), GcodeError> {
    for (name, text) in [("start", &templates.start), ("end", &templates.end)] {
        render(name, text, &|variable| {
            let known = VARIABLES.iter().any(|(v, _)| *v == variable);
            let late = matches!(variable, "max_z" | "park_z");
            (known && (name == "end" || !late)).then(String::new)
        })?;
    }
    Ok(())
}

/// Whether a template uses one of these variables.
pub(crate) fn uses(text: &str, variables: &[&str]) -> bool {
    variables.iter().any(|v| text.contains(&format!("{{{v}}}")))
}

/// The text with its variables replaced; `{{` and `}}` are braces.
pub(crate) fn render(
    template: &'static str,
    text: &str,
    value: &dyn Fn(&str) -> Option<String>,
) -> Result<String, GcodeError> {
    let mut out = String::with_capacity(text.len() + 64);
    for (index, line) in text.lines().enumerate() {
        let fail = |at: usize, message: String| GcodeError::Template {
            template,
            line: index + 1,
            column: line[..at].chars().count() + 1,
            message,
        };
        let mut rest = line;
        while let Some(brace) = rest.find(['{', '}']) {
            let at = line.len() - rest.len() + brace;
            out.push_str(&rest[..brace]);
            let (tail, open) = (&rest[brace + 1..], rest[brace..].starts_with('{'));
            if tail.starts_with(if open { '{' } else { '}' }) {
                out.push(if open { '{' } else { '}' });
                rest = &tail[1..];
                continue;
            }
            let Some(end) = tail.find('}').filter(|_| open) else {
                return Err(fail(at, "a brace without its partner".into()));
            };
            let name = &tail[..end];
            out.push_str(
                &value(name).ok_or_else(|| fail(at, format!("no variable is called {name:?}")))?,
            );
            rest = &tail[end + 1..];
        }
        out.push_str(rest);
        out.push('\n');
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_and_braces() {
        let value = |name: &str| (name == "t").then(|| "215".to_owned());
        for (text, expected) in [
            ("", ""),
            ("G28", "G28\n"),
            ("M104 S{t} ; {{t}}\nM109 S{t}", "M104 S215 ; {t}\nM109 S215\n"),
            ("{t}{t}", "215215\n"),
        ] {
            assert_eq!(render("start", text, &value).unwrap(), expected);
        }
        for (text, line, column) in [("a\n é{u}", 2, 3), ("{t", 1, 1), ("x } y", 1, 3)] {
            let error = render("end", text, &value).unwrap_err();
            let GcodeError::Template { template: "end", line: l, column: c, .. } = error else {
                panic!("{error}");
            };
            assert_eq!((l, c), (line, column), "{text:?}");
        }
    }

    #[test]
    fn heights_are_known_at_the_end_only() {
        let templates = |start: &str, end: &str| Templates {
            start: start.into(),
            end: end.into(),
            ..Templates::default()
        };
        assert!(check(&templates("", "G1 Z{park_z}")).is_ok());
        assert!(check(&templates("G1 Z{park_z}", "")).is_err());
    }
}
