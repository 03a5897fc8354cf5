//! How to read the report: each quantity in a line, with its source.

/// Terms and what they mean, in ready HTML.
const TERMS: [(&str, &str); 16] = [
    (
        "Stride",
        "One full cycle of the four feet, here from one strike of the left hind to the next (Hildebrand \
         1965).",
    ),
    (
        "Stride time, stride length",
        "Duration of a stride, found where the movement closes upon itself; and speed times that duration.",
    ),
    (
        "Stance, swing",
        "The time a hoof is on the ground, from foot strike to lift-off; and the time it is not.",
    ),
    (
        "Duty factor",
        "Share of the stride a foot is down. Hildebrand&#8217;s first number is its mean over the hind \
         feet (Hildebrand 1965).",
    ),
    (
        "Lateral lag",
        "Share of the stride by which a forefoot follows the hind foot of the same side: \
         Hildebrand&#8217;s second number. 0 is a pace, 0.25 an even walk, 0.5 a trot (Hildebrand 1965).",
    ),
    (
        "Support time",
        "Time per stride in which at least one hoof is down. The published contact times are most likely \
         this (Huang 2012, Fig. 3.9).",
    ),
    (
        "Suspension",
        "Time in which no hoof is down; gathered when a fore lifts off last and a hind strikes first, the \
         legs folded under the body.",
    ),
    (
        "Lead",
        "In a canter or gallop the side whose foot of a pair strikes second; transverse when fore and \
         hind agree, rotary when not (Hildebrand 1977).",
    ),
    (
        "Contact-time law",
        "<i>T</i><sub>c</sub> = <i>a v</i><sup><i>b</i></sup>, <i>v</i> in m/s (Huang 2012, Eq. 3.1); \
         shapes borrowed for single captures from Witte et al. 2006 (gallop, one limb) and Hoyt, Wickler \
         &amp; Cogger 2000 (one limb).",
    ),
    (
        "Step length",
        "<i>D</i> = <i>v T</i><sub>c</sub>: how far the body travels during the contact (Huang 2012, Eq. \
         3.2).",
    ),
    (
        "Amble rule",
        "With one capture the parent curve is shifted in time until it meets the point (Huang 2012, Fig. \
         3.10).",
    ),
    (
        "Froude number",
        "<i>v</i>&#178;/(<i>g L</i>) with the leg length <i>L</i>, 0.77 of withers height; horses change \
         from walk to trot near 0.35 (Griffin et al. 2004).",
    ),
    (
        "Residual",
        "Distance of a fitted joint from the point a person placed: px on the plate, cm on the track, \
         percent of withers height. RMS is the root mean square.",
    ),
    (
        "Held-out error",
        "The same for a visible point whose keypoint the fit was not shown in any panel: what the \
         skeleton and the smoothness predict by themselves.",
    ),
    (
        "Near, off",
        "Towards the camera and away from it. Left and right are the horse&#8217;s own; LH, LF, RF, RH \
         are its feet.",
    ),
    ("Root", "The top of the croup, where the chain of bones begins."),
];

/// The section.
pub(super) fn reading() -> String {
    let terms: String =
        TERMS.iter().map(|(term, meaning)| format!("<dt>{term}</dt><dd>{meaning}</dd>\n")).collect();
    format!("<section id=\"reading\"><h2>How to read this</h2>\n<dl>\n{terms}</dl></section>\n")
}
