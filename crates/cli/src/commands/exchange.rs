//! `muybridge annotations import` and `export`: placed points from and to other annotation tools.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use image::GrayImage;
use muybridge_capture::exchange::{
    ExchangeError, Existing, ExportOptions, ExportPicture, Format, ImportFile, LARGEST_FILE_BYTES, Merged,
    PictureSource, Space, export, import,
};
use muybridge_capture::{
    Document, Manifest, hash_file, locate_image, relative_path, write_atomically, write_json,
};
use muybridge_imaging::{Cutouts, LoadLimits, PanelView, load_gray};

/// Folder of manifests when only a plate's identifier is given.
const PLATES: &str = "plates";

/// Names of formats on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum FormatName {
    /// A `DeepLabCut` project (`CollectedData_<scorer>.csv`), and the same points with likelihoods.
    Deeplabcut,
    /// COCO keypoints, one JSON file.
    Coco,
    /// labelme, one JSON file a picture.
    Labelme,
    /// One point a row, in plate px, for R and pandas.
    Csv,
}

impl FormatName {
    fn format(self) -> Format {
        match self {
            Self::Deeplabcut => Format::DeepLabCut,
            Self::Coco => Format::Coco,
            Self::Labelme => Format::Labelme,
            Self::Csv => Format::Csv,
        }
    }
}

/// Names of pixel spaces on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum SpaceName {
    /// Each panel is a picture of its own.
    Panel,
    /// The plate is the picture.
    Plate,
}

/// Arguments of `export`.
#[derive(Debug, Args)]
pub(super) struct ExportArguments {
    /// Plate identifier or annotation file.
    pub(super) plate: String,
    /// Whose format.
    #[arg(long, value_enum)]
    format: FormatName,
    /// Folder to write to; it is made where it is missing.
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// Pixels of which pictures, where the format leaves the choice [default: panel; csv: plate]
    #[arg(long, value_enum)]
    space: Option<SpaceName>,
    /// Write the pictures too (panels are cut out in grey).
    #[arg(long)]
    images: bool,
    /// Who labelled, for `DeepLabCut` [default: the annotator's name]
    #[arg(long, value_name = "NAME")]
    scorer: Option<String>,
    /// Write over files that are there and differ.
    #[arg(long)]
    replace: bool,
}

/// Arguments of `import`.
#[derive(Debug, Args)]
pub(super) struct ImportArguments {
    /// Files of one format, or a folder of labelme files.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Plate identifier or annotation file; an identifier may be that of a plate nobody has annotated.
    #[arg(long, value_name = "PLATE")]
    pub(super) into: String,
    /// Whose format [default: what the file looks like]
    #[arg(long, value_enum)]
    format: Option<FormatName>,
    /// JSON object from names in the files to ours, null for a point to leave away.
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Annotation to write [default: the plate's, if there is none yet or with --replace]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Imported points replace those that are there, and an existing file is written over.
    #[arg(long)]
    replace: bool,
}

/// Writes an annotation as files of another tool.
pub(super) fn run_export(annotation_path: &Path, arguments: &ExportArguments) -> anyhow::Result<()> {
    let document = Document::open(annotation_path, None)?;
    let (manifest, annotation) = (&document.draft().manifest, &document.draft().annotation);
    let options = ExportOptions {
        space: arguments.space.map(|space| match space {
            SpaceName::Panel => Space::Panel,
            SpaceName::Plate => Space::Plate,
        }),
        scorer: arguments.scorer.clone(),
    };
    let format = arguments.format.format();
    let exported = export(manifest, annotation, &Cutouts::new(manifest), format, &options)?;
    let mut files = exported.files;
    if arguments.images {
        files.extend(pictures(&document, &exported.pictures)?);
    }
    let files: Vec<(PathBuf, Vec<u8>)> =
        files.into_iter().map(|(path, content)| (arguments.out.join(path), content)).collect();
    let differs = |(path, content): &&(PathBuf, Vec<u8>)| {
        path.exists() && !std::fs::read(path).is_ok_and(|old| old == *content)
    };
    if let Some((path, _)) = files.iter().find(differs).filter(|_| !arguments.replace) {
        bail!(
            "{}: is there already and differs; import work done in it first, choose another --out, or --replace it",
            path.display()
        );
    }
    for (path, content) in &files {
        let folder = path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
        write_atomically(path, content)?;
        println!("{}", path.display());
    }
    for note in &exported.notes {
        eprintln!("note: {note}");
    }
    Ok(())
}

/// The pictures of an export, encoded: cut-outs as PNG, whole files as they are.
fn pictures(document: &Document, wanted: &[ExportPicture]) -> anyhow::Result<Vec<(String, Vec<u8>)>> {
    if wanted.is_empty() {
        bail!("a table speaks of no pictures; leave --images away");
    }
    let manifest = &document.draft().manifest;
    let mut loaded: BTreeMap<usize, GrayImage> = BTreeMap::new();
    let mut written = Vec::new();
    for picture in wanted {
        let content = match picture.source {
            PictureSource::Image(index) => {
                let path = image_path(document, index)?;
                std::fs::read(&path).with_context(|| path.display().to_string())?
            }
            PictureSource::Panel(number) => {
                let panel = manifest.panels.iter().find(|panel| panel.panel == number);
                let panel = panel.with_context(|| format!("there is no panel {number}"))?;
                let plate = match loaded.entry(panel.image) {
                    Entry::Occupied(there) => there.into_mut(),
                    Entry::Vacant(free) => {
                        free.insert(load_gray(&image_path(document, panel.image)?, LoadLimits::default())?)
                    }
                };
                let view = PanelView::new(plate, panel.quad_px, u32::MAX);
                png(&view
                    .with_context(|| format!("panel {number} cannot be cut out; correct its corners"))?
                    .image)?
            }
        };
        written.push((picture.path.clone(), content));
    }
    Ok(written)
}

/// An image file of the plate on this machine, which must be the one the points were placed on.
fn image_path(document: &Document, index: usize) -> anyhow::Result<PathBuf> {
    let image = document.draft().manifest.images.get(index).context("the manifest has no such image")?;
    let path = locate_image(document.manifest_path(), &image.file);
    if !path.exists() {
        bail!("{}: not on this machine; fetch it, or leave --images away", path.display());
    }
    if hash_file(&path)? != image.sha256 {
        bail!(
            "{}: not the image the points were placed on (its hash differs from the manifest's)",
            path.display()
        );
    }
    Ok(path)
}

fn png(picture: &GrayImage) -> anyhow::Result<Vec<u8>> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).context("cannot encode the picture")?;
    Ok(bytes.into_inner())
}

/// Puts points of other tools' files into an annotation.
pub(super) fn run_import(annotation_path: &Path, arguments: &ImportArguments) -> anyhow::Result<()> {
    let out = arguments.out.as_deref().unwrap_or(annotation_path);
    if out.exists() && !arguments.replace {
        bail!(
            "{}: is there already; write elsewhere with --out FILE and compare, or --replace the points in it",
            out.display()
        );
    }
    let files = read_files(&arguments.files)?;
    let document = open_or_start(annotation_path, arguments)?;
    let manifest = &document.draft().manifest;
    let names = own_names(arguments.map.as_deref())?;
    let format = arguments.format.map(FormatName::format);
    let imported = import(&files, format, manifest, &Cutouts::new(manifest), &names)?;
    for note in &imported.notes {
        eprintln!("note: {note}");
    }
    if imported.point_count() == 0 {
        bail!("no point could be taken over; nothing was written");
    }
    let mut annotation = document.draft().annotation.clone();
    let existing = if arguments.replace { Existing::Replace } else { Existing::KeepHand };
    let Merged { added, replaced, same, kept } = imported.merge_into(&mut annotation, existing);
    annotation.plate = relative_path(out, document.manifest_path());
    write_json(out, &annotation)?;
    println!(
        "{}: {added} points added, {replaced} replaced, {same} the same as before, \
         {kept} left away where a person's point is there",
        out.display()
    );
    Ok(())
}

/// The annotation of a plate, or a new one for a plate that has none.
fn open_or_start(annotation_path: &Path, arguments: &ImportArguments) -> anyhow::Result<Document> {
    if annotation_path.exists() || arguments.into.ends_with(".json") {
        return Ok(Document::open(annotation_path, None)?);
    }
    let manifest_path = Path::new(PLATES).join(format!("{}.json", arguments.into));
    let manifest = Manifest::read(&manifest_path)?;
    Ok(Document::start(&manifest_path, annotation_path, manifest, None)?)
}

/// The files, and of a folder those that end in `.json`, in the order of their names.
fn read_files(paths: &[PathBuf]) -> anyhow::Result<Vec<ImportFile>> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(read_file(path)?);
            continue;
        }
        let entries = std::fs::read_dir(path).with_context(|| path.display().to_string())?;
        let mut inside: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        inside.retain(|file| file.extension().is_some_and(|extension| extension == "json"));
        inside.sort();
        if inside.is_empty() {
            bail!("{}: holds no labelme files (.json); name a file", path.display());
        }
        for file in &inside {
            files.push(read_file(file)?);
        }
    }
    Ok(files)
}

/// A file's content, of which no more is read than can be used.
fn read_file(path: &Path) -> anyhow::Result<ImportFile> {
    let name = path.display().to_string();
    let unreadable = || format!("{name}: cannot be read; check the path and its permissions");
    let file = std::fs::File::open(path).with_context(unreadable)?;
    let mut content = Vec::new();
    file.take(LARGEST_FILE_BYTES as u64 + 1).read_to_end(&mut content).with_context(unreadable)?;
    Ok(ImportFile { name, content })
}

/// A person's table of names.
fn own_names(path: Option<&Path>) -> anyhow::Result<BTreeMap<String, Option<String>>> {
    let Some(path) = path else { return Ok(BTreeMap::new()) };
    let text = muybridge_capture::read_text(path)?;
    serde_json::from_str(&text).map_err(|error| {
        let message =
            format!("{error}; it must be an object such as {{\"Nearknee\": \"near_knee\", \"Eye\": null}}");
        let (file, place) = (path.display().to_string(), "names".into());
        ExchangeError::Content { file, place, message }.into()
    })
}
