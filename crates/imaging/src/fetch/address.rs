//! The address of an image service, and those below it.

use std::net::IpAddr;

use ureq::http::Uri;

use super::FetchError;

/// The base address of an image service.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Address {
    base: String,
    loopback: bool,
}

impl Address {
    /// Takes a base address with or without `/` or `/info.json` at its end.
    ///
    /// # Errors
    /// When it is no address, is not encrypted though it leaves this computer, or has parts that a service has not.
    pub(super) fn parse(given: &str) -> Result<Self, FetchError> {
        let fault = |fault| FetchError::Address { address: given.into(), fault };
        let base = given.trim().trim_end_matches('/');
        let base = base.strip_suffix("/info.json").unwrap_or(base).trim_end_matches('/');
        let uri: Uri = base.parse().map_err(|_| fault("no address"))?;
        let loopback = is_loopback(&uri);
        match uri.scheme_str() {
            Some("https") => {}
            Some("http") if loopback => {}
            Some("http") => return Err(fault("not encrypted (http)")),
            _ => return Err(fault("no web address")),
        }
        if base.contains(['?', '#'])
            || uri.authority().is_none_or(|authority| authority.as_str().contains('@'))
        {
            return Err(fault("has a query, a fragment or a user's name"));
        }
        Ok(Self { base: base.into(), loopback })
    }

    /// Whether the service runs on this computer, so that its address need not be encrypted.
    pub(super) fn is_loopback(&self) -> bool {
        self.loopback
    }

    /// The base address, without `/` at its end.
    pub(super) fn base(&self) -> &str {
        &self.base
    }

    /// Address of the description.
    pub(super) fn info(&self) -> String {
        format!("{}/info.json", self.base)
    }

    /// Address of a region at a size, as JPEG.
    /// It rests on the address given, never on the `id` of the description: behind proxies the `id` is often wrong, and
    /// it could lead anywhere.
    pub(super) fn picture(&self, region: &str, size: &str) -> String {
        format!("{}/{region}/{size}/0/default.jpg", self.base)
    }
}

/// Whether an address stays on this computer.
pub(super) fn is_loopback(uri: &Uri) -> bool {
    let host = uri.host().unwrap_or_default().trim_matches(['[', ']']);
    host == "localhost" || host.parse::<IpAddr>().is_ok_and(|address| address.is_loopback())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_cleaned_and_checked() {
        for given in ["https://a.org/iiif/x", " https://a.org/iiif/x/ ", "https://a.org/iiif/x/info.json"] {
            assert_eq!(Address::parse(given).unwrap().info(), "https://a.org/iiif/x/info.json");
        }
        for local in ["http://127.0.0.1:80/x", "http://localhost/x", "http://[::1]:9/x"] {
            assert!(Address::parse(local).unwrap().is_loopback());
        }
        for bad in [
            "",
            "616",
            "ftp://a/x",
            "http://a.org/x",
            "http://10.0.0.1/x",
            "https://a/x?y",
            "https://u@a/x",
            "https:// a",
        ] {
            let error = Address::parse(bad).unwrap_err().to_string();
            assert!(error.starts_with(bad) && error.contains("IIIF image service"), "{error}");
        }
    }
}
