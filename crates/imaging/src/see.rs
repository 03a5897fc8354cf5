//! What is in a panel: silhouette, ground, wall, hooves.
