//! Plates from their IIIF Image API services.
