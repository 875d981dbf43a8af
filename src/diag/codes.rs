//! The table of diagnostic codes. A code is stable: its meaning never changes and its number is never used again.
//!
//! `E`/`W` is the severity. The hundreds tell the stage: 0 reading and parsing, 1 names, 2 values and types, 3 properties
//! and blocks, 4 evaluation and its guards, 5 files and assets, 6 the scene as a whole, 7 rendering.
//! Each code's page for `ogee explain` is `explain/<CODE>.md`: why, a fenced broken scene, a fenced mended one.

use super::Severity;

macro_rules! codes {
    ($($name:ident = $text:literal, $title:literal;)*) => {
        /// A kind of fault, by its stable code.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Code { $(#[doc = $title] $name),* }

        impl Code {
            /// Every code, in the order of the table.
            pub const ALL: &[Code] = &[$(Code::$name),*];

            /// The stable text: "E0101".
            pub fn text(self) -> &'static str {
                match self { $(Code::$name => $text),* }
            }

            /// What the code means, in a phrase.
            pub fn title(self) -> &'static str {
                match self { $(Code::$name => $title),* }
            }

            /// The page of `ogee explain`, in Markdown.
            pub fn explanation(self) -> &'static str {
                match self { $(Code::$name => include_str!(concat!("explain/", $text, ".md"))),* }
            }
        }
    };
}

codes! {
    // 0: reading and parsing
    Syntax = "E0001", "the text is not a scene";
    Unclosed = "E0002", "a bracket or brace is not closed";
    TooDeep = "E0003", "brackets or comments are nested too deeply";
    BadNumber = "E0004", "a number cannot be read";
    BadString = "E0005", "a text or its interpolation is malformed";
    ChainedComparison = "E0006", "comparisons do not chain";
    UnknownKind = "E0007", "no block is of this kind";
    ReservedName = "E0008", "a reserved word cannot be a name";
    FileTooLarge = "E0009", "a scene file is too large";
    NotUtf8 = "E0010", "a scene file is not UTF-8 text";
    MissingComma = "E0011", "a comma may be missing in a vector";
    // 1: names
    UnknownName = "E0101", "a name is not defined";
    DuplicateName = "E0102", "a name is defined twice in one scope";
    NotAssignable = "E0103", "only a `var` can be assigned";
    UsedBeforeSet = "E0104", "a name is used before it has a value";
    // 2: values and types
    TypeMismatch = "E0201", "a value is of the wrong type";
    WrongArity = "E0202", "a call has the wrong arguments";
    NotCallable = "E0203", "a value that is not a function is called";
    NoSuchField = "E0204", "a value has no such component or method";
    IndexOutOfRange = "E0205", "an index is outside its list";
    NotFinite = "E0206", "an operation has no finite value";
    DivisionByZero = "E0207", "a division by zero";
    Undefined = "E0208", "a function is undefined at this argument";
    // 3: properties and blocks
    UnknownProperty = "E0301", "a block has no such property";
    MissingProperty = "E0302", "a block lacks a property it needs";
    BadProperty = "E0303", "a property's value cannot be used";
    DuplicateProperty = "E0304", "a property is given twice";
    ConflictingProperties = "E0305", "two properties exclude each other";
    LabelInsideObject = "E0306", "a labelled block stands where a property is meant";
    NotPlaceable = "E0307", "a value that is no object or light is placed";
    UnknownWord = "E0309", "a word is not one of those the property takes";
    EnergyGain = "W0310", "a material returns more light than it gets";
    NotSolid = "E0311", "a surface that is no solid is put together with solids";
    OutsideLimits = "E0312", "an angle is outside its joint's limits";
    UnknownJoint = "E0313", "a skeleton has no joint or tip of this name";
    NotReached = "W0314", "a target is not reached";
    // 4: evaluation and its guards
    AssertFailed = "E0401", "an assertion does not hold";
    UserError = "E0402", "the scene calls `error`";
    CallDepth = "E0403", "calls are nested too deeply";
    LoopLimit = "E0404", "a loop runs too long";
    ListLimit = "E0405", "a list or text grows too long";
    MemoryLimit = "E0406", "the scene needs too much memory";
    ImportCycle = "E0407", "files import each other in a circle";
    ReturnOutside = "E0408", "`return` stands outside a function";
    ImportedRender = "W0409", "a camera or render block of an import is left out";
    NotSampled = "E0410", "a function cannot run while rendering";
    PlacementLimit = "E0411", "groups in groups stand for too many shapes";
    // 5: files and assets
    FileNotFound = "E0501", "a file cannot be read";
    BadMesh = "E0502", "a mesh file cannot be used";
    MeshRepaired = "W0503", "a mesh file was mended on reading";
    MissingMaterialFile = "W0504", "a material file or texture of a mesh or model is missing";
    BadImage = "E0505", "an image cannot be read";
    BadPatch = "E0507", "a patch file cannot be used";
    BadMotion = "E0508", "a motion capture file cannot be used";
    BadModel = "E0510", "a model file cannot be used";
    ModelRepaired = "W0511", "a model file was mended on reading, or is not drawn whole";
    // 6: the scene as a whole
    NoCamera = "E0601", "the scene has no camera";
    NoLight = "W0602", "the scene has no light";
    NothingToSee = "W0603", "the scene has no object";
    BadGeometry = "E0604", "a shape is degenerate";
    UnknownCamera = "E0605", "no camera has this label";
    UnknownSetting = "E0606", "`--set` names no top-level `let`";
    BadWeights = "E0608", "weights of a skin cannot be used";
    WeightsNormalised = "W0609", "weights of a skin do not add up to 1";
    EmptySolid = "W0607", "nothing is left of solids that are put together";
    // 7: rendering
    UndefinedSample = "E0701", "a function is undefined at samples of the picture";
    NonFiniteSample = "W0702", "samples of the picture are infinite or not a number";
}

impl Code {
    /// The code with this text, upper or lower case.
    pub fn from_text(text: &str) -> Option<Code> {
        Code::ALL.iter().copied().find(|code| code.text().eq_ignore_ascii_case(text))
    }

    /// Error or warning, by the first letter.
    pub fn severity(self) -> Severity {
        if self.text().starts_with('W') { Severity::Warning } else { Severity::Error }
    }
}
