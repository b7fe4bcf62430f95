//! Search for numbers that are infinite or NaN in any value.

/// Returns `true` if all numbers in the `Debug` text of a value are finite. The function ignores
/// quoted texts.
pub(crate) fn is_finite(debug: &str) -> bool {
    let mut bare = String::with_capacity(debug.len());
    let (mut is_text, mut is_escaped) = (false, false);
    for letter in debug.chars() {
        if is_escaped {
            is_escaped = false;
        } else if is_text && letter == '\\' {
            is_escaped = true;
        } else if letter == '"' {
            is_text = !is_text;
        } else if !is_text {
            bare.push(letter);
        }
    }
    let words = bare.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
    words.into_iter().all(|word| !matches!(word, "NaN" | "inf"))
}
