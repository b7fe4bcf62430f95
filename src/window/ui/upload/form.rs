//! The form for an upload.

use std::{net::SocketAddr, path::PathBuf, sync::Arc};

use egui::{Button, RichText, Role, Sense, Ui, WidgetInfo, vec2};

use super::Choice;
use crate::{
    contract::{
        transfer::{FileName, FileNameError, Peer, TleFile},
        uploads::{Cargo, Chosen, Order},
    },
    device::ElementFiles,
    orbit::Catalog,
    station::Antenna,
    ui::{
        text, theme,
        widgets::{
            card,
            form::{ROW, text_field},
            segmented,
        },
    },
};

/// Width of a label, and max width of its field, points.
const WIDTHS: [f32; 2] = [72.0, 360.0];
const LOG_IN: f32 = 168.0;
const SSH: &str = "22";

/// Input of the operator for one antenna.
pub(super) struct Form {
    takes: &'static ElementFiles,
    pub(super) file: String,
    pub(super) host: String,
    pub(super) port: String,
    pub(super) folder: String,
    pub(super) user: String,
    pub(super) uses_key: bool,
    pub(super) key_file: String,
    /// Catalog numbers of the chosen satellites; `None` for the favourites.
    pub(super) numbers: Option<Vec<u32>>,
    /// Satellite that the operator has marked for the unit to follow.
    pub(super) marked: Option<u32>,
    /// Satellite that the unit will follow.
    pub(super) satellite: Option<u32>,
    pub(super) search: String,
    pub(super) kept_is_open: bool,
    checked: Option<Checked>,
}

/// The chosen satellites, checked. The result stays valid until an input changes.
struct Checked {
    catalog: Arc<Catalog>,
    numbers: Vec<u32>,
    chosen: Arc<Chosen>,
}

impl Form {
    /// Returns the form prefilled from the settings of `antenna`, whose unit accepts these files.
    pub(super) fn new(antenna: &Antenna, takes: &'static ElementFiles) -> Self {
        let connection = &antenna.connection;
        Self {
            takes,
            file: connection.element_file().unwrap_or_default(),
            host: host(&connection.address),
            port: SSH.to_owned(),
            folder: takes.folder.to_owned(),
            user: String::new(),
            uses_key: false,
            key_file: String::new(),
            numbers: None,
            marked: None,
            satellite: None,
            search: String::new(),
            kept_is_open: false,
            checked: None,
        }
    }

    pub(super) fn choose(&mut self, choice: Choice, favourites: &[u32]) {
        match choice {
            Choice::These(numbers) => self.numbers = Some(numbers),
            Choice::Also(number) => {
                let before = self.numbers.as_deref().unwrap_or(favourites);
                if !before.contains(&number) {
                    self.numbers = Some([before, &[number]].concat());
                }
            }
        }
    }

    /// Returns the chosen satellites as they are in `catalog`.
    pub(super) fn chosen(&mut self, catalog: &Arc<Catalog>, favourites: &[u32]) -> Arc<Chosen> {
        let numbers = self.numbers.as_deref().unwrap_or(favourites);
        let is_known = |checked: &Checked| {
            Arc::ptr_eq(&checked.catalog, catalog) && checked.numbers == numbers
        };
        let checked = self.checked.take().filter(is_known).unwrap_or_else(|| Checked {
            catalog: Arc::clone(catalog),
            numbers: numbers.to_vec(),
            chosen: Arc::new(Chosen::new(catalog, numbers, self.takes)),
        });
        Arc::clone(&self.checked.insert(checked).chosen)
    }

    /// Returns the catalog numbers of the last checked satellites.
    pub(super) fn known_numbers(&self) -> Option<&[u32]> {
        self.checked.as_ref().map(|checked| checked.numbers.as_slice())
    }

    /// Returns the file of the chosen satellites, or the reason why there is none.
    pub(super) fn chosen_file(
        &mut self,
        catalog: &Arc<Catalog>,
        favourites: &[u32],
    ) -> Result<TleFile, String> {
        self.chosen(catalog, favourites).file.clone().map_err(|error| error.to_string())
    }

    /// Returns the entered name of the file.
    pub(super) fn file_name(&self) -> Result<FileName, FileNameError> {
        FileName::new(self.file.trim(), self.takes)
    }

    /// Returns the server of the unit's files.
    pub(super) fn peer(&self) -> Result<Peer, String> {
        let host = self.host.trim();
        if host.is_empty() || host.contains(char::is_whitespace) {
            return Err("enter the unit's host name or IP address, without spaces".to_owned());
        }
        let port = self.port.trim().parse().ok().filter(|port| *port > 0);
        let port = port.ok_or("enter a port from 1 to 65535")?;
        Ok(Peer { host: host.to_owned(), port })
    }

    /// Returns the order, or the input that is missing for an order.
    pub(super) fn order(
        &self,
        antenna: &str,
        cargo: Result<Cargo, String>,
    ) -> Result<Order, String> {
        let cargo = cargo?;
        let missing = |typed: &str, subject: &str| {
            if typed.trim().is_empty() { Err(format!("enter {subject} to upload")) } else { Ok(()) }
        };
        missing(&self.file, "the name of the file on the unit")?;
        let file = self.file_name().map_err(|error| error.to_string())?;
        let unit = self.peer()?;
        missing(&self.user, "the unit's user name")?;
        missing(&self.folder, "the folder on the unit")?;
        if self.uses_key {
            missing(&self.key_file, "the path of the key file")?;
        }
        Ok(Order {
            antenna: antenna.to_owned(),
            takes: self.takes,
            unit,
            folder: self.folder.trim().to_owned(),
            file,
            user: self.user.trim().to_owned(),
            key_file: self.uses_key.then(|| PathBuf::from(self.key_file.trim())),
            cargo,
            satellite: self.satellite,
            is_unattended: false,
        })
    }
}

/// Returns the host of an address such as `unit:4001` or `[::1]:4001`.
fn host(address: &str) -> String {
    if let Ok(address) = address.parse::<SocketAddr>() {
        return address.ip().to_string();
    }
    address.rsplit_once(':').map_or(address, |(host, _)| host).to_owned()
}

pub(super) fn show(ui: &mut Ui, form: &mut Form) {
    card::show(ui, f32::INFINITY, |ui| {
        ui.label(RichText::new("On the unit").font(text::value()));
        text_field(ui, ("File", "such as weather.txt"), WIDTHS, &mut form.file);
        text_field(ui, ("Folder", "on the unit"), WIDTHS, &mut form.folder);
        text_field(ui, ("Host", "name or IP address"), WIDTHS, &mut form.host);
        text_field(ui, ("Port", SSH), WIDTHS, &mut form.port);
        text_field(ui, ("User", "on the unit"), WIDTHS, &mut form.user);
        ui.horizontal_wrapped(|ui| {
            let factory_user = form.takes.factory_user;
            let offered = form.user != factory_user;
            let response = ui.add_enabled(offered, Button::new("Factory user"));
            let name = format!("Take the factory user {factory_user}");
            response.widget_info(|| WidgetInfo::labeled(Role::Button, offered, &name));
            if response.on_hover_text(name).clicked() {
                factory_user.clone_into(&mut form.user);
            }
            let ways = [("Password", false), ("Key file", true)];
            let (place, _) = ui.allocate_exact_size(vec2(LOG_IN, ROW), Sense::hover());
            segmented::choose(ui, "log in", place, "Log-in", &ways, &mut form.uses_key);
        });
        if form.uses_key {
            text_field(ui, ("Key file", "/home/…/.ssh/id_ed25519"), WIDTHS, &mut form.key_file);
        } else {
            let t = theme::tokens(ui);
            let words = "Azel asks for the password after it has checked the host.";
            ui.label(RichText::new(words).font(text::small()).color(t.t3));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        controller::satrak::{ELEMENT_FILE, ELEMENT_FILES},
        orbit::bundled,
    };

    fn form() -> Form {
        let mut antenna = Antenna::satrak("Satrak", "192.168.10.21:4001");
        antenna.connection.put(&ELEMENT_FILE, "active.txt").unwrap();
        Form { user: "op".to_owned(), ..Form::new(&antenna, &ELEMENT_FILES) }
    }

    fn file() -> Cargo {
        let catalog = bundled().unwrap();
        Cargo::New(TleFile::new(catalog.get(25_544), &ELEMENT_FILES).unwrap())
    }

    #[test]
    fn the_unit_is_where_the_antenna_is() {
        let order = form().order("Satrak", Ok(file())).unwrap();
        assert_eq!(order.unit, Peer { host: "192.168.10.21".to_owned(), port: 22 });
        assert_eq!(
            (order.file.as_str(), order.folder.as_str()),
            ("active.txt", ELEMENT_FILES.folder)
        );
        assert_eq!(
            (host("unit.local:4001"), host("[::1]:4001")),
            ("unit.local".into(), "::1".into())
        );
    }

    #[test]
    fn what_is_missing_is_said() {
        let problem = |form: Form| form.order("Satrak", Ok(file())).unwrap_err();
        let part = |edit: fn(&mut Form)| {
            let mut form = form();
            edit(&mut form);
            problem(form)
        };
        assert!(part(|form| form.host.clear()).contains("host"));
        assert!(part(|form| form.port = "70000".into()).contains("port"));
        assert!(part(|form| form.port = "0".into()).contains("port"));
        assert!(part(|form| form.user = " ".into()).contains("user"));
        assert!(part(|form| form.folder.clear()).contains("folder"));
        assert!(part(|form| form.file = "a/b".into()).contains("slash"));
        assert!(part(|form| form.uses_key = true).contains("key file"));
        let nothing = form().order("Satrak", Err("no satellite was chosen".to_owned()));
        assert!(nothing.unwrap_err().contains("no satellite"));
    }

    #[test]
    fn the_choice_is_checked_once_and_again_when_it_changes() {
        let catalog = Arc::new(bundled().unwrap());
        let mut form = form();
        assert_eq!(form.chosen(&catalog, &[25_544]).objects.len(), 1);
        assert_eq!(form.chosen(&catalog, &[25_544, 43_013]).objects.len(), 2);
        form.numbers = Some(Vec::new());
        assert!(form.chosen_file(&catalog, &[25_544]).is_err());
    }
}
