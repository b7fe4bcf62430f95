//! Certificate authorities of the system.

use std::sync::OnceLock;

use rustls::pki_types::CertificateDer;

/// Returns the system's certificate authorities in DER, or the ones in `SSL_CERT_FILE` and
/// `SSL_CERT_DIR`. Reads them once. Empty on a system without authorities.
pub fn system_authorities() -> &'static [CertificateDer<'static>] {
    static AUTHORITIES: OnceLock<Vec<CertificateDer<'static>>> = OnceLock::new();
    AUTHORITIES.get_or_init(|| {
        let found = rustls_native_certs::load_native_certs();
        for error in &found.errors {
            tracing::warn!(%error, "a certificate authority of the system cannot be read");
        }
        found.certs
    })
}
