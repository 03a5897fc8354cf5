//! What a service says of its picture: `info.json` of the IIIF Image API, versions 2 and 3.

use serde::Deserialize;
use serde_json::Value;

use super::FetchError;
use super::error::beginning;

/// Version of the Image API.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Version {
    /// 2.0 and 2.1.
    Two,
    /// 3.0.
    Three,
}

/// What a service says of its picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Description {
    version: Version,
    /// Width and height of the whole picture, px.
    pub(super) full_px: [u32; 2],
    most: Most,
    /// Width and height of the tiles that are served at full size, px.
    tiles_px: Vec<[u32; 2]>,
    /// Sizes of the whole picture that are served, px.
    sizes_px: Vec<[u32; 2]>,
    /// Any region can be asked for.
    serves_regions: bool,
}

/// The largest picture that is served in one answer.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Most {
    width_px: u32,
    height_px: u32,
    area_px: u64,
}

impl Most {
    fn allows(&self, [width, height]: [u32; 2]) -> bool {
        width <= self.width_px && height <= self.height_px && area([width, height]) <= self.area_px
    }
}

fn area([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height)
}

/// The members of `info.json` that matter here, of both versions.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Info {
    width: u64,
    height: u64,
    #[serde(default)]
    profile: Value,
    #[serde(flatten)]
    most: InfoMost,
    tiles: Option<Vec<InfoTiles>>,
    sizes: Option<Vec<InfoSize>>,
    extra_features: Option<Vec<String>>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
struct InfoMost {
    max_width: Option<u32>,
    max_height: Option<u32>,
    max_area: Option<u64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct InfoTiles {
    width: u32,
    height: Option<u32>,
    #[serde(default)]
    scale_factors: Vec<f64>,
}

#[derive(Deserialize)]
struct InfoSize {
    width: u32,
    height: u32,
}

/// Version 2 keeps limits and features in objects of the `profile` list.
#[derive(Default, Deserialize)]
struct InfoProfile {
    #[serde(flatten)]
    most: InfoMost,
    #[serde(default)]
    supports: Vec<String>,
}

impl Description {
    /// Reads an `info.json` that came from `url`.
    ///
    /// # Errors
    /// When it is none of version 2 or 3, or the picture has more than `most_pixels`.
    pub(super) fn parse(url: &str, json: &[u8], most_pixels: u64) -> Result<Self, FetchError> {
        let fault = |fault: String| FetchError::NotIiif { url: url.into(), fault };
        let no_json = |error| fault(format!("no JSON but {}: {error}", beginning(json)));
        let value: Value = serde_json::from_slice(json).map_err(no_json)?;
        let version = version(&value).map_err(|text| fault(text.into()))?;
        let info = Info::deserialize(&value).map_err(|error| fault(error.to_string()))?;
        let (width, height) = (info.width, info.height);
        if width == 0 || height == 0 {
            return Err(fault(format!("the picture is {width} x {height} px")));
        }
        let full_px = match (u32::try_from(width), u32::try_from(height)) {
            (Ok(width), Ok(height)) if area([width, height]) <= most_pixels => [width, height],
            _ => return Err(FetchError::TooManyPixels { url: url.into(), width, height, most: most_pixels }),
        };
        let (names, objects) = profile(&info.profile).map_err(|error| fault(format!("profile: {error}")))?;
        let features =
            objects.iter().flat_map(|object| &object.supports).chain(info.extra_features.iter().flatten());
        let serves_regions = features.into_iter().any(|feature| feature == "regionByPx")
            || names.iter().any(|name| name.contains("level1") || name.contains("level2"));
        let tiles = info.tiles.into_iter().flatten().filter(|tiles| tiles.scale_factors.contains(&1.0));
        let tiles_px = tiles.map(|tiles| [tiles.width, tiles.height.unwrap_or(tiles.width)]);
        let sizes_px = info.sizes.into_iter().flatten().map(|size| [size.width, size.height]);
        Ok(Self {
            version,
            full_px,
            most: most(&info.most, &objects),
            tiles_px: tiles_px.filter(|&tile| area(tile) > 0).collect(),
            sizes_px: sizes_px.filter(|&size| area(size) > 0).collect(),
            serves_regions,
        })
    }

    /// Whether the picture is larger than what is served in one answer.
    pub(super) fn is_limited(&self) -> bool {
        !self.most.allows(self.full_px)
    }

    /// Size of the regions that the whole picture can be put together from at full size, px: the largest tiles the
    /// service lists, otherwise the largest regions it allows. None when it allows the whole picture and lists no
    /// tiles, or serves no regions.
    pub(super) fn tile_px(&self) -> Option<[u32; 2]> {
        let listed = self
            .tiles_px
            .iter()
            .copied()
            .filter(|&tile| self.most.allows(tile))
            .max_by_key(|&tile| area(tile));
        listed.or_else(|| (self.is_limited() && self.serves_regions).then(|| self.largest_region_px()))
    }

    fn largest_region_px(&self) -> [u32; 2] {
        let [width, height] = self.full_px;
        let region = [width.min(self.most.width_px), height.min(self.most.height_px)];
        if self.most.allows(region) {
            return region;
        }
        // A square of the allowed area is smaller than a picture's side.
        let side = self.most.area_px.isqrt() as u32;
        region.map(|length| length.min(side))
    }

    /// The `size` of requests for the whole picture, best first. A smaller one only where there are no tiles.
    pub(super) fn whole_sizes(&self) -> Vec<String> {
        let mut sizes = vec!["max".into()];
        // `max` came with version 2.1, which calls `full` deprecated but knows it.
        if self.version == Version::Two && !self.is_limited() {
            sizes.insert(0, "full".into());
        }
        if self.tile_px().is_none() {
            let listed = self.sizes_px.iter().copied().filter(|&size| self.most.allows(size));
            let smaller = listed.max_by_key(|&size| area(size)).unwrap_or_else(|| self.allowed_px());
            sizes.push(self.size(smaller));
        }
        sizes
    }

    /// Whether a picture of this size can be the whole one, perhaps made smaller: the same shape, but for rounding.
    pub(super) fn has_shape_of(&self, size_px: [u32; 2]) -> bool {
        let [full_width, full_height] = self.full_px.map(f64::from);
        let [width, height] = size_px.map(f64::from);
        let by_width = (height - full_height * width / full_width).abs();
        let by_height = (width - full_width * height / full_height).abs();
        width <= full_width && height <= full_height && by_width.min(by_height) <= 1.0
    }

    /// The largest size of the whole picture within the limits.
    fn allowed_px(&self) -> [u32; 2] {
        let [width, height] = self.full_px.map(f64::from);
        let by_area = (self.most.area_px as f64 / (width * height)).sqrt();
        let scale = (f64::from(self.most.width_px) / width)
            .min(f64::from(self.most.height_px) / height)
            .min(by_area)
            .min(1.0);
        [width, height].map(|length| (length * scale).floor().max(1.0) as u32)
    }

    /// `region` and `size` of a request for a part of the picture at full size, in the canonical form of the version,
    /// which is the only one that servers of ready-made files know.
    pub(super) fn region(&self, [x, y]: [u32; 2], size_px: [u32; 2]) -> (String, String) {
        let [width, height] = size_px;
        let region =
            if size_px == self.full_px { "full".into() } else { format!("{x},{y},{width},{height}") };
        (region, self.size(size_px))
    }

    fn size(&self, [width, height]: [u32; 2]) -> String {
        match self.version {
            Version::Two => format!("{width},"),
            Version::Three => format!("{width},{height}"),
        }
    }
}

/// The version, which the context says; where that is missing, the name of the address member.
fn version(info: &Value) -> Result<Version, &'static str> {
    let contexts = match &info["@context"] {
        Value::Array(contexts) => contexts.iter().filter_map(Value::as_str).collect(),
        context => context.as_str().map_or_else(Vec::new, |context| vec![context]),
    };
    let says = |text: &str| contexts.iter().any(|context| context.contains(text));
    let is_image = info["protocol"] == "http://iiif.io/api/image";
    if says("/image/3/") || info["type"] == "ImageService3" || (is_image && info["id"].is_string()) {
        Ok(Version::Three)
    } else if says("/image/2/") || (is_image && info["@id"].is_string()) {
        Ok(Version::Two)
    } else if says("/image/1/") || says("library.stanford.edu") || info["scale_factors"].is_array() {
        Err("version 1 of the API, which is not supported")
    } else {
        Err("its @context is of no version of the IIIF Image API")
    }
}

/// Names and objects of a `profile`, which may be one or a list.
fn profile(profile: &Value) -> Result<(Vec<String>, Vec<InfoProfile>), serde_json::Error> {
    let entries = profile.as_array().map_or(std::slice::from_ref(profile), Vec::as_slice);
    let names = entries.iter().filter_map(Value::as_str).map(String::from).collect();
    let objects = entries.iter().filter(|entry| entry.is_object()).map(InfoProfile::deserialize);
    Ok((names, objects.collect::<Result<_, _>>()?))
}

/// A missing `maxHeight` is as `maxWidth` (both versions say so); zero is no limit.
fn most(top: &InfoMost, objects: &[InfoProfile]) -> Most {
    let all = || objects.iter().map(|object| &object.most).chain([top]);
    let width_px = all().find_map(|most| most.max_width).filter(|&v| v > 0);
    let height_px = all().find_map(|most| most.max_height).filter(|&v| v > 0).or(width_px);
    let area_px = all().find_map(|most| most.max_area).filter(|&v| v > 0);
    Most {
        width_px: width_px.unwrap_or(u32::MAX),
        height_px: height_px.unwrap_or(u32::MAX),
        area_px: area_px.unwrap_or(u64::MAX),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(json: &str) -> Result<Description, FetchError> {
        Description::parse("https://x/info.json", json.as_bytes(), 1_000_000_000)
    }

    #[test]
    fn version_2_with_limits_in_the_profile() {
        let info = parse(
            r#"{"@context": "http://iiif.io/api/image/2/context.json", "@id": "http://evil/x", "width": 6000, "height": 4000,
            "profile": ["http://iiif.io/api/image/2/level1.json", {"formats": ["jpg"], "maxWidth": 5000}],
            "tiles": [{"width": 256, "scaleFactors": [1, 2]}, {"width": 512, "scaleFactors": [2]}]}"#,
        )
        .unwrap();
        assert!(info.is_limited());
        assert_eq!(info.tile_px(), Some([256, 256]));
        assert_eq!(info.region([256, 0], [256, 100]), ("256,0,256,100".into(), "256,".into()));
        assert_eq!(info.whole_sizes(), ["max"]);
        assert!(
            info.has_shape_of([6000, 4000])
                && info.has_shape_of([1000, 667])
                && info.has_shape_of([1000, 666])
        );
        assert!(!info.has_shape_of([1000, 600]) && !info.has_shape_of([6001, 4000]));
    }

    #[test]
    fn version_3_with_an_area_and_no_tiles() {
        let info = parse(
            r#"{"@context": ["x", "http://iiif.io/api/image/3/context.json"], "type": "ImageService3", "profile": "level2",
            "width": 6000, "height": 4000, "maxWidth": 5000, "maxHeight": 3000, "maxArea": 1000000}"#,
        )
        .unwrap();
        assert_eq!(info.tile_px(), Some([1000, 1000]));
        assert_eq!(info.region([0, 0], [1000, 1000]).1, "1000,1000");
        assert_eq!(info.region([0, 0], [6000, 4000]).0, "full");
        // sqrt(1e6 / 24e6) = 0.2041.
        let unsplit = Description { serves_regions: false, ..info };
        assert_eq!(unsplit.tile_px(), None);
        assert_eq!(unsplit.whole_sizes(), ["max", "1224,816"]);
    }

    #[test]
    fn without_a_limit_the_whole_is_asked_for() {
        let text = r#"{"@context": "http://iiif.io/api/image/2/context.json", "profile": "http://iiif.io/api/image/2/level0.json",
            "width": 60, "height": 40, "maxWidth": 60, "sizes": [{"width": 30, "height": 20}, {"width": 15, "height": 10}]}"#;
        let info = parse(text).unwrap();
        assert!(!info.is_limited());
        assert_eq!(info.tile_px(), None);
        assert_eq!(info.whole_sizes(), ["full", "max", "30,"]);
    }

    #[test]
    fn what_is_no_description_says_why() {
        let cases = [
            ("<html>", "no JSON"),
            ("{}", "@context"),
            (
                r#"{"@context": "http://library.stanford.edu/iiif/image-api/1.1/context.json", "width": 1}"#,
                "version 1",
            ),
            (r#"{"type": "ImageService3", "width": 5}"#, "height"),
            (r#"{"type": "ImageService3", "width": "5", "height": 5}"#, "invalid type"),
            (r#"{"type": "ImageService3", "width": 0, "height": 5}"#, "0 x 5"),
            (r#"{"type": "ImageService3", "width": 9000000000, "height": 5}"#, "megapixels"),
            ("[]", "@context"),
        ];
        for (text, expected) in cases {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.contains(expected) && error.contains("https://x/info.json"), "{text}: {error}");
        }
    }
}
