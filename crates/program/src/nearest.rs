//! The names that a name was most likely meant to be.

/// The names of `known` that `name` was most likely meant to be, for an error: at most three.
pub fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let mut ranked: Vec<(usize, &str)> = known
        .map(|k| (distance(&name.to_lowercase(), &k.to_lowercase()), k))
        .filter(|&(d, k)| d <= 1 + k.len().max(name.len()) / 3)
        .collect();
    ranked.sort();
    ranked.truncate(3);
    ranked.iter().map(|(_, k)| format!("`{k}`")).collect::<Vec<_>>().join(", ")
}

/// Edit distance (Levenshtein), by one row.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().take(64).enumerate() {
        let mut corner = i;
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let replaced = corner + usize::from(x != y);
            corner = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(corner + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    const KNOWN: [&str; 4] =
        ["linear", "tool_change", "generic-3axis-linuxcnc", "generic-3axis-haas"];

    #[test]
    fn a_slip_of_the_pen_is_understood() {
        let nearest = |name| nearest(name, KNOWN.into_iter());
        assert_eq!(nearest("liner"), "`linear`");
        assert_eq!(nearest("tool_chnge"), "`tool_change`");
        assert!(nearest("Generic-3axis-linuxcmc").starts_with("`generic-3axis-linuxcnc`"));
        assert_eq!(nearest("qqqqqqqqqqq"), "");
    }
}
