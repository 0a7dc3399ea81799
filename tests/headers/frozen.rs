//! What version 1 of the ABI has, as lines that stay.

use crate::layout;

/// What hosts are built with: constants, fields in their order with their offsets, sizes, functions and callbacks, a line each.
///
/// The release's own version and what macros begin a struct with are no part of it: a struct with struct_size may grow.
///
/// - `header`: as [`c_header`](crate::c_header) gives it.
pub fn abi(header: &str) -> Vec<String> {
    let mut lines = Vec::new();
    for line in header.lines() {
        let mut words = line.split_whitespace();
        if words.next() == Some("#define")
            && let (Some(name), Some(value)) = (words.next(), words.next())
            && name.starts_with("SDEF_")
            && !name.starts_with("SDEF_VERSION_")
            && (value == "UINT32_MAX" || value.parse::<u32>().is_ok())
        {
            lines.push(format!("constant {name} {value}"));
        }
    }
    let code: Vec<&str> = header
        .lines()
        .map(|line| line.split("//").next().unwrap_or("").trim())
        .filter(|line| !line.starts_with('#') && !line.is_empty())
        .collect();
    let code = code.join(" ");
    for listed in code.split("enum {").skip(1).filter_map(|rest| rest.split('}').next()) {
        lines.extend(listed.split(',').map(|entry| format!("constant {}", entry.trim().replace(" = ", " "))));
    }
    let ends_at = |rest: &str, end: char| rest.split(end).next().unwrap_or("").to_string();
    for rest in code.split("typedef ").skip(1) {
        match rest.strip_prefix("struct ").and_then(|rest| rest.split_once('{')) {
            Some((name, fields)) => {
                let fields = ends_at(fields, '}');
                let field = |field: &str| format!("field {}: {}", name.trim(), field.trim());
                lines.extend(fields.trim().split_terminator(';').map(field));
            }
            None => lines.push(format!("type {}", ends_at(rest, ';'))),
        }
    }
    lines.extend(code.split("SDEF_API ").skip(1).map(|rest| format!("function {}", ends_at(rest, ';'))));
    lines.extend(layout(header).lines().filter(|line| is_placed(line)).map(str::to_string));
    lines
}

/// A line of the layout that says a size or an offset.
fn is_placed(line: &str) -> bool {
    line.starts_with("SIZE(") || line.starts_with("AT(")
}

/// The struct, what follows its name, and the number of a line `SIZE(struct, number);` or `AT(struct, field, number);`.
fn placed<'a>(line: &'a str, kind: &str) -> Option<(&'a str, usize)> {
    let inner = line.strip_prefix(kind)?.strip_prefix('(')?.strip_suffix(");")?;
    let (name, rest) = inner.split_once(", ")?;
    Some((name, rest.rsplit(", ").next()?.parse().ok()?))
}

/// What of `frozen` a host that was built with it would miss in `now`, or find elsewhere.
pub fn broken(frozen: &[String], now: &[String]) -> Vec<String> {
    let mut broken = Vec::new();
    for line in frozen {
        if let Some((name, size)) = placed(line, "SIZE") {
            let own = now.iter().filter_map(|line| placed(line, "SIZE")).find(|(of, _)| *of == name);
            let says_its_size = frozen.contains(&format!("AT({name}, struct_size, 0);"));
            match own {
                Some((_, own)) if own == size || (own > size && says_its_size) => {}
                Some((_, own)) if own > size => {
                    broken.push(format!("{name} goes by value and has grown from {size} bytes to {own}"));
                }
                _ => broken.push(format!("{name} has become smaller than {size} bytes")),
            }
            // In the padding at its end an older host has anything. What goes by value does not grow at all.
            let is_new = |line: &&String| line.starts_with("AT(") && !frozen.contains(line);
            let early = now
                .iter()
                .filter(is_new)
                .filter(|line| placed(line, "AT").is_some_and(|(of, at)| of == name && at < size));
            broken.extend(early.map(|line| format!("{line} lies within the {size} bytes that {name} had")));
        } else if !now.contains(line) {
            broken.push(format!("gone or changed: {line}"));
        }
    }
    broken
}
