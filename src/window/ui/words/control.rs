//! Words for the party in control of an antenna.

use crate::contract::control::{NetworkClient, Party};

/// Names a party in the middle of a sentence.
pub fn party(party: Party) -> String {
    match party {
        Party::Window => "the window".to_owned(),
        Party::Automatic => "automatic operation".to_owned(),
        Party::Command => "an azel command".to_owned(),
        Party::Program(address) => format!("the program at {address}"),
    }
}

/// Names a connected program at the beginning of a sentence: its process name and its address.
fn program(client: &NetworkClient) -> String {
    let name = client.program.as_deref().unwrap_or("A program");
    format!("{name} ({})", client.address)
}

/// Describes a program in control; `last` is its last line and the age of that line.
pub fn in_control(client: &NetworkClient, last: Option<(&str, &str)>) -> String {
    let program = program(client);
    match last {
        Some((line, age)) if !line.is_empty() => {
            format!("{program} is in control. Last line, {age} ago: {line}")
        }
        _ => format!("{program} is in control."),
    }
}

/// Describes a program whose motion waits for the operator's decision.
pub fn asks_for_control(client: &NetworkClient, in_control: Option<Party>) -> String {
    let program = program(client);
    match in_control {
        None => format!("{program} asks to point the antenna."),
        Some(other) => {
            format!("{program} asks to point the antenna. Now {} is in control.", party(other))
        }
    }
}

/// A program that asked, and hung up before the operator had decided.
pub fn asked_for_control(client: &NetworkClient) -> String {
    let program = program(client);
    format!("{program} asked to point the antenna, and hung up. Hand over, then connect it again.")
}

/// Connected programs of which none asks for control.
pub fn connected(clients: &[NetworkClient], in_control: Option<Party>) -> String {
    let programs = match clients {
        [client] => format!("{} is connected.", program(client)),
        clients => format!("{} programs are connected.", clients.len()),
    };
    match in_control {
        None => format!("{programs} Nobody is in control."),
        Some(Party::Window) => format!("{programs} You are in control."),
        Some(other) => format!("{programs} {} is in control.", capital(&party(other))),
    }
}

/// Describes a port that the operating system refuses.
pub fn port_failed(reason: &str) -> String {
    format!(
        "The port for other programs is not open: {reason}. Azel tries again every 5 s. Close the \
         other program, or choose another port in the station file."
    )
}

/// Describes a port for metrics that the operating system refuses.
pub fn metrics_port_failed(reason: &str) -> String {
    format!("The port is not open: {reason}. Azel tries again every 5 s, or choose another port.")
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn client(program: Option<&str>) -> NetworkClient {
        let address = "127.0.0.1:40000".parse().unwrap();
        NetworkClient::new(address, program.map(str::to_owned), jiff::Timestamp::UNIX_EPOCH)
    }

    #[test]
    fn a_program_has_its_name_and_its_address() {
        let gpredict = client(Some("gpredict"));
        assert_eq!(
            in_control(&gpredict, Some(("P 180.00 45.00", "1.2 s"))),
            "gpredict (127.0.0.1:40000) is in control. Last line, 1.2 s ago: P 180.00 45.00"
        );
        assert_eq!(
            asks_for_control(&client(None), None),
            "A program (127.0.0.1:40000) asks to point the antenna."
        );
        assert_eq!(
            asks_for_control(&gpredict, Some(Party::Automatic)),
            "gpredict (127.0.0.1:40000) asks to point the antenna. Now automatic operation is in \
             control."
        );
        assert_eq!(
            connected(std::slice::from_ref(&gpredict), Some(Party::Command)),
            "gpredict (127.0.0.1:40000) is connected. An azel command is in control."
        );
        assert_eq!(
            connected(&[gpredict.clone(), gpredict], None),
            "2 programs are connected. Nobody is in control."
        );
    }
}
