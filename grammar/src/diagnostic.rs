//! What is wrong with a text, as plain data: code, message, places, help.
//!
//! A diagnostic holds no source text; whoever shows it joins it with its
//! [`SourceFile`](crate::SourceFile). The first label is *the* place. Every message says what,
//! where, why and what to do.

use crate::{Fix, Span};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// A fact worth knowing; never changes the exit code.
    Advice,
    /// It can be solved, and the answer may mislead.
    Warning,
    /// The problem has no meaning, or no unique trajectory.
    Error,
}

/// A place and what is to be said about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is to be seen there.
    pub text: String,
}

/// One finding about a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Which kind of finding.
    pub code: Code,
    /// Severity; usually that of the code.
    pub severity: Severity,
    /// One line, complete by itself.
    pub message: String,
    /// The first is the place; the others say why.
    pub labels: Vec<Label>,
    /// What to do about it, if that can be said.
    pub help: Option<String>,
    /// Ways to repair the text, the best one first.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// A finding at a place, with the severity its code usually has.
    pub fn new(
        code: Code,
        message: impl Into<String>,
        span: Span,
        label: impl Into<String>,
    ) -> Self {
        Diagnostic {
            code,
            severity: code.severity(),
            message: message.into(),
            labels: vec![Label { span, text: label.into() }],
            help: None,
            fixes: Vec::new(),
        }
    }

    /// Adds a further place.
    pub fn label(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    /// Says what to do.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// Says how to change the text.
    pub fn fix(mut self, fix: Fix) -> Self {
        self.fixes.push(fix);
        self
    }

    /// The place.
    pub fn span(&self) -> Span {
        self.labels[0].span
    }
}

/// Declares [`Code`] from one table: variant, printed code, severity, title.
macro_rules! codes {
    ($($variant:ident = $code:literal, $severity:ident, $title:literal;)*) => {
        /// The kinds of findings. Each has a page in `docs/diagnostics/`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Code { $(#[doc = concat!("`", $code, "`: ", $title)] $variant),* }

        impl Code {
            /// Every code, in order.
            pub const ALL: &[Code] = &[$(Code::$variant),*];

            /// The code as printed, such as `FDC0101`.
            pub fn as_str(self) -> &'static str {
                match self { $(Code::$variant => $code),* }
            }

            /// The severity a finding of this code has unless said otherwise.
            pub fn severity(self) -> Severity {
                match self { $(Code::$variant => Severity::$severity),* }
            }

            /// A short title.
            pub fn title(self) -> &'static str {
                match self { $(Code::$variant => $title),* }
            }

            /// Its page, for `fdcc explain` and for editors, read when `fdcc` is built: why it is
            /// given, a wrong model and a right one, in Markdown.
            pub fn page(self) -> &'static str {
                match self {
                    $(Code::$variant => {
                        include_str!(concat!("../../docs/diagnostics/", $code, ".md"))
                    })*
                }
            }
        }
    };
}

codes! {
    MissingOperator = "FDC0001", Error, "a missing operator";
    Unfinished = "FDC0002", Error, "something is missing or superfluous";
    ReservedWord = "FDC0003", Error, "a reserved word used as a name";
    TooDeep = "FDC0004", Error, "nested too deeply";
    UnknownItem = "FDC0005", Error, "an unknown item word";
    Unclosed = "FDC0006", Error, "a bracket without its partner";
    NotText = "FDC0007", Error, "not a text file";
    EmptyModel = "FDC0008", Warning, "a file without any item";
    TooLarge = "FDC0009", Error, "a file that is too large to be a model";
    UselessAllow = "FDC0010", Warning, "an `allow` that silences nothing";
    Unseen = "FDC0011", Error, "a character that is not seen";
    UnknownName = "FDC0101", Error, "an unknown name";
    DuplicateName = "FDC0102", Error, "a name declared twice";
    WrongKind = "FDC0103", Error, "a name of the wrong kind";
    WrongArguments = "FDC0104", Error, "the wrong number of arguments";
    ShapeMismatch = "FDC0105", Error, "vectors of different sizes";
    UnknownSetting = "FDC0106", Error, "an unknown method key or value";
    EqualityGuard = "FDC0107", Error, "`==` in a guard";
    CircularDefinition = "FDC0108", Error, "a definition that needs itself";
    NotAllowedHere = "FDC0109", Error, "an expression that has no meaning here";
    UnknownPart = "FDC0110", Error, "an unknown part or index";
    UnknownUnit = "FDC0111", Error, "an unknown unit";
    Lookalike = "FDC0112", Error, "two names that look alike";
    SetEquality = "FDC0201", Error, "`=` with a set on the right";
    SetValuedHere = "FDC0202", Error, "a set-valued function where a number is needed";
    HiddenJump = "FDC0203", Error, "a jump used as an ordinary function";
    NoSet = "FDC0204", Advice, "`in` without a set";
    NotAffine = "FDC0205", Error, "a right side that is not affine in `Sgn`";
    SetProduct = "FDC0206", Warning, "a product of two set-valued functions";
    VanishingGradient = "FDC0301", Error, "a surface whose gradient vanishes on it";
    Repelling = "FDC0302", Error, "a surface that pushes solutions away on both sides";
    OtherCoordinates = "FDC0303", Advice, "a surface that is one-sided Lipschitz in other \
                                           coordinates";
    NotContracting = "FDC0304", Warning, "a crossed surface that is not one-sided Lipschitz";
    StartOnSurface = "FDC0305", Advice, "a start that lies on a surface";
    ControlJumps = "FDC0306", Warning, "a control that acts differently on the two sides of a \
                                        surface";
    EndlessJumps = "FDC0310", Error, "jumps that can fire without end";
    IdleJump = "FDC0311", Warning, "a jump that never acts";
    ConstantSurface = "FDC0312", Warning, "a surface that never changes sides";
    MovingRest = "FDC0313", Warning, "a surface that leaves what rests on it behind";
    EmptyBounds = "FDC0401", Error, "bounds that leave no room";
    NoDuration = "FDC0402", Error, "a free time without lower bound";
    NoBoundary = "FDC0403", Error, "a state without start or end condition";
    Unused = "FDC0404", Warning, "a name that is never used";
    NoEquation = "FDC0405", Error, "a state without equation";
    NotSmooth = "FDC0406", Warning, "a constraint that is not twice differentiable";
    NoTime = "FDC0407", Error, "a model without time";
    NoValue = "FDC0408", Error, "a parameter without a value";
    GuessOutside = "FDC0409", Warning, "a guess outside its bounds";
    Contradiction = "FDC0410", Error, "conditions that contradict each other";
    NotANumber = "FDC0411", Error, "a constant or bound that is no finite number";
    LinkedStart = "FDC0412", Error, "a link onto a start that is given";
    LeftOut = "FDC0413", Advice, "a state that a link leaves out";
    TimeGap = "FDC0414", Advice, "linked phases whose times do not meet";
    TimeOutside = "FDC0415", Error, "a condition at a time that is not inside of the horizon";
    TimeBeside = "FDC0416", Error, "a condition at a time beside phases, surfaces or data";
    NothingMoves = "FDC0417", Warning, "a condition at a time that reads no state";
    OrderOfTimes = "FDC0418", Advice, "conditions at times whose order the bounds leave open";
    LongStep = "FDC0501", Warning, "a step too long for the smoothed layer";
    SweepTooSlow = "FDC0502", Warning, "a sweep that refines the grid too slowly";
    NoRoom = "FDC0503", Warning, "a smoothing width without room";
    Scales = "FDC0504", Advice, "states of very different sizes";
    NotFinite = "FDC0601", Error, "not a number while solving";
    Infeasible = "FDC0602", Error, "no feasible trajectory found";
    NotYet = "FDC0603", Error, "a construct that `solve` cannot treat yet";
    UnitMismatch = "FDC0701", Error, "units that do not fit together";
    UnitHere = "FDC0702", Error, "a unit where a plain number is needed";
    UnitOfPower = "FDC0703", Error, "a power whose unit is not fixed";
    BareNumber = "FDC0704", Error, "a plain number that would have to guess its unit";
    DataFile = "FDC0801", Error, "a data file that cannot be read";
    DataColumns = "FDC0802", Error, "a data file that does not fit its columns";
    RowOrder = "FDC0803", Error, "rows that are not in the order of time";
    RowBeyondTime = "FDC0804", Error, "a row beyond the time of the model";
    BeyondTable = "FDC0805", Warning, "a curve that is needed beyond its data";
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

impl std::str::FromStr for Code {
    type Err = ();

    /// Reads `FDC0101`, `fdc0101`, `0101` or `101`.
    fn from_str(text: &str) -> Result<Self, ()> {
        let digits = text.trim().to_ascii_uppercase();
        let number: u32 = digits.strip_prefix("FDC").unwrap_or(&digits).parse().map_err(|_| ())?;
        let wanted = format!("FDC{number:04}");
        Code::ALL.iter().copied().find(|code| code.as_str() == wanted).ok_or(())
    }
}
