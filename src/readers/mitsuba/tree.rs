//! Parser of Mitsuba XML to a tree of objects with typed properties.
//!
//! The parser resolves `<default>`, `<include>`, `<alias>` and `$parameters`. It converts the camelCase names of
//! Mitsuba 0.6 to those of 3.x.

use super::grammar::{has_attribute, is_object, snake_case};
use super::value::{self, PropertyValue};
use super::xml_file::XmlFile;
use crate::error::{Location, Log, SceneError};
use crate::file::{folder_of, read_text};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Maximum nesting of elements and of included files.
const MAX_DEPTH: usize = 48;
/// Maximum number of files of a scene. A chain of n files that each include the next one twice would have 2ⁿ.
const MAX_FILES: usize = 4096;
/// Maximum number of bytes that `$parameters` expand to. Values made of values would grow without limit.
const MAX_SUBSTITUTED: usize = 1 << 24;

/// An instance of a plugin, such as `<bsdf type="diffuse" id="a">`, and its content.
#[derive(Debug)]
pub(super) struct Object {
    /// Tag: `bsdf`, `shape`, `emitter`, ...
    pub tag: String,
    /// Attribute `type`; `scene` for the root.
    pub plugin: String,
    pub id: Option<String>,
    pub place: Location,
    pub properties: Vec<ObjectProperty>,
    pub children: Vec<ChildObject>,
}

impl Object {
    fn new(tag: &str, plugin: &str, id: Option<&str>, place: Location) -> Object {
        let (tag, plugin, id) = (tag.to_owned(), plugin.to_owned(), id.map(str::to_owned));
        Object { tag, plugin, id, place, properties: Vec::new(), children: Vec::new() }
    }
}

/// A named value.
#[derive(Debug)]
pub(super) struct ObjectProperty {
    pub name: String,
    pub value: PropertyValue,
    pub place: Location,
    /// True if a converter has asked for it; unused properties are reported.
    pub used: Cell<bool>,
}

/// An object inside another, directly or by reference.
#[derive(Debug)]
pub(super) struct ChildObject {
    pub target: ChildTarget,
    /// Name of the parameter whose value the object is.
    pub name: Option<String>,
    pub place: Location,
    /// True if a converter has asked for it.
    pub used: Cell<bool>,
}

/// Target of a child: an object or a reference.
#[derive(Debug)]
pub(super) enum ChildTarget {
    Own(Rc<Object>),
    Reference(String),
}

/// A parsed description.
#[derive(Debug)]
pub(super) struct SceneXml {
    pub root: Object,
    ids: BTreeMap<String, Rc<Object>>,
    /// Files read, main file first, with the hash of the bytes of each.
    pub sources: Vec<(PathBuf, u64)>,
    /// True if the main file is of Mitsuba 0.x.
    pub is_old: bool,
    /// Folders that `<path>` elements name, in their order.
    folders: Vec<PathBuf>,
}

impl SceneXml {
    /// Reads a file and the files that it includes. Errors within objects go to `log`.
    pub fn read(path: &Path, given: &[(String, String)], log: &mut Log) -> Result<SceneXml, SceneError> {
        let mut builder = XmlReader::new(given, log);
        let mut root = Object::new("scene", "scene", None, Location::file(path));
        builder.file(path, &Location::file(path), &mut root, None, 0)?;
        for (name, _) in builder.parameters.iter().filter(|(_, parameter)| !parameter.used.get()) {
            let what = format!("nothing in the scene depends on the parameter ${name}");
            let remedy = "correct the name given with -D, or leave it out";
            builder.log.part::<()>(Err(Location::file(path).wrong(what, remedy)));
        }
        let XmlReader { ids, sources, is_old, folders, .. } = builder;
        Ok(SceneXml { root, ids, sources, is_old, folders })
    }

    /// Returns the path of a file in one of the folders that `<path>` elements name; the last one counts first.
    pub fn in_folders(&self, file: &str) -> Option<PathBuf> {
        in_folders(&self.folders, file)
    }

    /// Returns the object that a child refers to.
    pub fn object(&self, child: &ChildObject) -> Result<Rc<Object>, SceneError> {
        match &child.target {
            ChildTarget::Own(object) => Ok(object.clone()),
            ChildTarget::Reference(id) => {
                let missing = || child.place.undefined("object", id);
                self.ids.get(id).cloned().ok_or_else(missing)
            }
        }
    }

    /// Returns all children of `object` with tag `tag` and marks them as used.
    pub fn tagged(&self, object: &Object, tag: &str) -> Result<Vec<Rc<Object>>, SceneError> {
        let mut found = Vec::new();
        for child in &object.children {
            let target = self.object(child)?;
            if target.tag == tag {
                child.used.set(true);
                found.push(target);
            }
        }
        Ok(found)
    }

    /// Returns the child of `object` that is the value of the parameter `name`.
    pub fn named(&self, object: &Object, name: &str) -> Result<Option<Rc<Object>>, SceneError> {
        let child = object.children.iter().find(|c| c.name.as_deref() == Some(name));
        child.inspect(|c| c.used.set(true)).map(|c| self.object(c)).transpose()
    }
}

/// The value of a `$name` parameter.
struct GivenParameter {
    value: String,
    /// True if the description uses it or has a default for it.
    used: Cell<bool>,
}

struct XmlReader<'a> {
    log: &'a mut Log,
    ids: BTreeMap<String, Rc<Object>>,
    /// Values of `$name` parameters.
    parameters: BTreeMap<String, GivenParameter>,
    /// Number of bytes that parameters have expanded to so far.
    substituted: Cell<usize>,
    sources: Vec<(PathBuf, u64)>,
    is_old: bool,
    folders: Vec<PathBuf>,
}

impl XmlReader<'_> {
    fn new<'a>(given: &[(String, String)], log: &'a mut Log) -> XmlReader<'a> {
        let parameter = |(name, value): &(String, String)| {
            (name.clone(), GivenParameter { value: value.clone(), used: Cell::new(false) })
        };
        let parameters = given.iter().map(parameter).collect();
        let substituted = Cell::new(0);
        let (ids, sources, folders) = (BTreeMap::new(), Vec::new(), Vec::new());
        XmlReader { log, ids, parameters, substituted, sources, is_old: false, folders }
    }

    /// Reads a file into `parent`: the content of a scene, or a single object under `name`.
    fn file(
        &mut self,
        path: &Path,
        from: &Location,
        parent: &mut Object,
        name: Option<String>,
        depth: usize,
    ) -> Result<(), SceneError> {
        if self.sources.len() == MAX_FILES {
            let remedy = "include each file once";
            return Err(from.wrong(format!("the scene includes more than {MAX_FILES} files"), remedy));
        }
        let (text, hash) = read_text(path, from)?;
        self.sources.push((path.to_owned(), hash));
        // Document types hold entities of small files. The library bounds what they expand to.
        let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
        let parsed = roxmltree::Document::parse_with_options(&text, options);
        let document = parsed.map_err(|e| Location::line(path, e.pos().row).malformed(e.to_string()))?;
        let file = &XmlFile::new(path, &text);
        let root = document.root_element();
        if root.tag_name().name() == "scene" {
            let place = file.place(&root);
            let Some(version) = root.attribute("version") else {
                let remedy = "give it one, e.g. <scene version=\"3.0.0\">";
                return Err(place.wrong("the scene has no version", remedy));
            };
            self.is_old |= self.sources.len() == 1 && version.starts_with("0.");
            self.report_unknown(&root, &place)?;
            self.contents(file, &root, parent, depth);
        } else {
            self.element(file, &root, parent, name, depth + 1)?;
        }
        Ok(())
    }

    /// Reads the elements inside `node` into `parent`. Elements with an error are left out.
    fn contents(&mut self, file: &XmlFile, node: &roxmltree::Node, parent: &mut Object, depth: usize) {
        for child in node.children().filter(|child| child.is_element()) {
            let read = self.element(file, &child, parent, None, depth + 1);
            self.log.part(read);
        }
    }

    fn element(
        &mut self,
        file: &XmlFile,
        node: &roxmltree::Node,
        parent: &mut Object,
        given_name: Option<String>,
        depth: usize,
    ) -> Result<(), SceneError> {
        let place = file.place(node);
        if depth > MAX_DEPTH {
            return Err(place.wrong("elements or includes nested too deeply", "flatten the file"));
        }
        let attributes = self.attributes(node, &place)?;
        self.report_unknown(node, &place)?;
        let get = |name: &str| attributes.get(name).map(String::as_str);
        let need = |name: &str| {
            let what = format!("<{}> lacks the attribute \"{name}\"", node.tag_name().name());
            get(name).ok_or_else(|| place.wrong(what, format!("add {name}=\"...\"")))
        };
        let child = |target: ChildTarget| ChildObject {
            target,
            name: given_name.as_deref().or(get("name")).map(snake_case),
            place: place.clone(),
            used: Cell::new(false),
        };
        match node.tag_name().name() {
            "default" => self.add_default(need("name")?, need("value")?),
            "include" => {
                let (name, included) = (get("name").map(str::to_owned), need("filename")?);
                let beside = || folder_of(file.path).join(included);
                let included = in_folders(&self.folders, included).unwrap_or_else(beside);
                self.file(&included, &place, parent, name, depth + 1)?;
            }
            "alias" => {
                let id = need("id")?;
                let object = self.ids.get(id).cloned().ok_or_else(|| place.undefined("object", id))?;
                self.ids.insert(need("as")?.to_owned(), object);
            }
            "ref" => parent.children.push(child(ChildTarget::Reference(need("id")?.to_owned()))),
            "path" => self.add_folder(folder_of(file.path).join(need("value")?), &place)?,
            tag if is_object(tag) || (tag == "spectrum" && get("type").is_some()) => {
                let kind = if tag == "spectrum" { "texture" } else { tag };
                let mut object = Object::new(kind, need("type")?, get("id"), place.clone());
                self.contents(file, node, &mut object, depth);
                parent.children.push(child(ChildTarget::Own(self.declared(object)?)));
            }
            tag => {
                let value = match tag {
                    "transform" => self.transform(file, node)?,
                    _ => value::parse(tag, &attributes, &place)?,
                };
                let name = snake_case(need("name")?);
                parent.properties.push(ObjectProperty { name, value, place, used: Cell::new(false) });
            }
        }
        Ok(())
    }

    /// Adds a folder in which files are searched.
    fn add_folder(&mut self, folder: PathBuf, place: &Location) -> Result<(), SceneError> {
        if !folder.is_dir() {
            let what = format!("the folder {} does not exist", folder.display());
            return self.log.warn(place, what, "files are searched beside the scene");
        }
        self.folders.push(folder);
        Ok(())
    }

    /// Gives a parameter its default value, unless it has a value.
    fn add_default(&mut self, name: &str, value: &str) {
        let default = GivenParameter { value: value.to_owned(), used: Cell::new(true) };
        self.parameters.entry(name.to_owned()).or_insert(default).used.set(true);
    }

    /// Registers the id of an object, and returns the object.
    fn declared(&mut self, object: Object) -> Result<Rc<Object>, SceneError> {
        let object = Rc::new(object);
        if let Some(id) = &object.id
            && let Some(other) = self.ids.insert(id.clone(), object.clone())
        {
            let what = format!("the id \"{id}\" is already taken at {}", other.place);
            return Err(object.place.wrong(what, "rename one of them"));
        }
        Ok(object)
    }

    /// Warns of attributes that an element does not have, and of text within it.
    fn report_unknown(&mut self, node: &roxmltree::Node, place: &Location) -> Result<(), SceneError> {
        let tag = node.tag_name().name();
        for attribute in node.attributes().filter(|attribute| !has_attribute(tag, attribute.name())) {
            let what = format!("the attribute \"{}\" of <{tag}> is not known", attribute.name());
            self.log.warn(place, what, "it is ignored")?;
        }
        let text = node.children().filter(|child| child.is_text()).filter_map(|child| child.text());
        match text.map(str::trim).find(|text| !text.is_empty()) {
            Some(text) => {
                let what = format!("<{tag}> has the text \"{}\"", text.chars().take(40).collect::<String>());
                self.log.warn(place, what, "it is ignored")
            }
            None => Ok(()),
        }
    }

    fn transform(&mut self, file: &XmlFile, node: &roxmltree::Node) -> Result<PropertyValue, SceneError> {
        let mut operations = Vec::new();
        for child in node.children().filter(|n| n.is_element()) {
            let place = file.place(&child);
            self.report_unknown(&child, &place)?;
            let attributes = self.attributes(&child, &place)?;
            operations.push((child.tag_name().name().to_owned(), attributes, place));
        }
        value::transform(&operations)
    }

    /// Returns the attributes with their `$parameters` replaced.
    fn attributes(
        &self,
        node: &roxmltree::Node,
        place: &Location,
    ) -> Result<BTreeMap<String, String>, SceneError> {
        let replaced =
            |a: roxmltree::Attribute| Ok((a.name().to_owned(), self.substitute(a.value(), place)?));
        node.attributes().map(replaced).collect()
    }

    fn substitute(&self, text: &str, place: &Location) -> Result<String, SceneError> {
        let mut out = String::new();
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            let (before, from) = rest.split_at(at);
            if let Some(before) = before.strip_suffix('\\') {
                out.push_str(before);
                out.push('$');
                rest = &from[1..];
                continue;
            }
            out.push_str(before);
            // The longest defined name that matches counts.
            let known = self.parameters.iter().filter(|(name, _)| from[1..].starts_with(name.as_str()));
            let Some((name, value)) = known.max_by_key(|(name, _)| name.len()) else {
                let name = from[1..].split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or("");
                let what = format!("the parameter ${name} has no value");
                return Err(place.wrong(what, format!("give it one with -D {name}=..., or a <default>")));
            };
            value.used.set(true);
            self.substituted.set(self.substituted.get() + value.value.len());
            if self.substituted.get() > MAX_SUBSTITUTED {
                let what = format!("the parameters become more than {} MiB of text", MAX_SUBSTITUTED >> 20);
                return Err(place.wrong(what, "do not build values from values"));
            }
            out.push_str(&value.value);
            rest = &from[1 + name.len()..];
        }
        out.push_str(rest);
        Ok(out)
    }
}

/// Returns the path of `file` in the last of the folders that has it.
fn in_folders(folders: &[PathBuf], file: &str) -> Option<PathBuf> {
    folders.iter().rev().map(|folder| folder.join(file)).find(|path| path.exists())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn camel_case_becomes_snake_case() {
        let pairs = [
            ("intIOR", "int_ior"),
            ("toWorld", "to_world"),
            ("diffuseReflectance", "diffuse_reflectance"),
            ("max_depth", "max_depth"),
            ("alphaU", "alpha_u"),
        ];
        for (camel, snake) in pairs {
            assert_eq!(snake_case(camel), snake);
        }
    }

    #[test]
    fn parameters_are_replaced_longest_first_and_escapes_kept() {
        let mut log = Log::new(false);
        let builder = XmlReader::new(&[("a".into(), "1".into()), ("ab".into(), "2".into())], &mut log);
        let place = Location::line(Path::new("x.xml"), 7);
        assert_eq!(builder.substitute(r"$a $ab-$a\$z", &place).unwrap(), "1 2-1$z");
        let message = builder.substitute("1 $nope", &place).unwrap_err().to_string();
        assert!(message.contains("x.xml:7") && message.contains("$nope"), "{message}");
    }
}
