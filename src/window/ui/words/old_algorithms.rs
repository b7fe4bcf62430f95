//! Sentences about old algorithms of SSH.

use crate::contract::transfer::{AlgorithmPart, OldAlgorithm};

/// Returns the sentence about a connection that used `old`; `None` if it used no old algorithm.
pub fn old_algorithms(old: &[OldAlgorithm]) -> Option<String> {
    let one = |old: &OldAlgorithm| {
        let part = match old.part {
            AlgorithmPart::KeyExchange => "key exchange",
            AlgorithmPart::HostKey => "host key type",
            AlgorithmPart::Cipher => "cipher",
            AlgorithmPart::Mac => "message authentication code",
        };
        format!("{part} {}", old.name)
    };
    let list = match old {
        [] => return None,
        [only] => format!("the old {}", one(only)),
        several => {
            let list: Vec<String> = several.iter().map(one).collect();
            format!("old algorithms ({})", list.join(", "))
        }
    };
    Some(format!(
        "Connected with {list}, because the server offers nothing better: update the server."
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_old_algorithm_is_named_with_its_part() {
        let old = |part, name: &str| OldAlgorithm { part, name: name.to_owned() };
        let kex = old(AlgorithmPart::KeyExchange, "diffie-hellman-group14-sha1");
        assert_eq!(old_algorithms(&[]), None);
        assert_eq!(
            old_algorithms(std::slice::from_ref(&kex)).unwrap(),
            "Connected with the old key exchange diffie-hellman-group14-sha1, because the server \
             offers nothing better: update the server."
        );
        let mac = old(AlgorithmPart::Mac, "hmac-sha1");
        let words = old_algorithms(&[kex, mac]).unwrap();
        let list =
            "(key exchange diffie-hellman-group14-sha1, message authentication code hmac-sha1)";
        assert!(words.contains(list), "{words}");
    }
}
