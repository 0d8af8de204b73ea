//! `fdcc explain`: why a diagnostic is given, a wrong model and a right one.

use clap::Args;
use fdcc_grammar::Code;

use super::Exit;
use crate::output;

/// Explain a diagnostic, with a wrong and a right model
#[derive(Args)]
pub struct Explain {
    /// Such as FDC0101 or 101
    code: String,
}

impl Explain {
    /// Prints the page of the code.
    pub fn run(self) -> Exit {
        match self.code.parse() {
            Ok(code) => {
                output::print(page(code));
                Exit::Fine
            }
            Err(()) => {
                output::complain(&format!("there is no diagnostic `{}`\n{}", self.code, similar(&self.code)));
                Exit::Usage
            }
        }
    }
}

/// The codes of the group that was meant, or all.
fn similar(code: &str) -> String {
    let digits: String = code.chars().filter(char::is_ascii_digit).collect();
    let prefix = format!("FDC{}", digits.get(..2).unwrap_or_default());
    let same_group = |code: &&Code| code.as_str().starts_with(&prefix);
    let mut codes: Vec<Code> = Code::ALL.iter().filter(same_group).copied().collect();
    if codes.is_empty() {
        codes = Code::ALL.to_vec();
    }
    let lines = codes.iter().map(|code| format!("\n  {code}  {}", code.title()));
    format!("did you mean one of these?{}", lines.collect::<String>())
}

/// The pages, read when `fdcc` is built.
macro_rules! pages {
    ($($variant:ident $code:literal)*) => {
        fn page(code: Code) -> &'static str {
            match code {
                $(Code::$variant => include_str!(concat!("../../../docs/diagnostics/", $code, ".md")),)*
            }
        }
    };
}

pages! {
    MissingOperator "FDC0001"
    Unfinished "FDC0002"
    ReservedWord "FDC0003"
    TooDeep "FDC0004"
    UnknownItem "FDC0005"
    Unclosed "FDC0006"
    NotText "FDC0007"
    EmptyModel "FDC0008"
    TooLarge "FDC0009"
    UselessAllow "FDC0010"
    UnknownName "FDC0101"
    DuplicateName "FDC0102"
    WrongKind "FDC0103"
    WrongArguments "FDC0104"
    ShapeMismatch "FDC0105"
    UnknownSetting "FDC0106"
    EqualityGuard "FDC0107"
    CircularDefinition "FDC0108"
    NotAllowedHere "FDC0109"
    UnknownPart "FDC0110"
    UnknownUnit "FDC0111"
    SetEquality "FDC0201"
    SetValuedHere "FDC0202"
    HiddenJump "FDC0203"
    NoSet "FDC0204"
    NotAffine "FDC0205"
    SetProduct "FDC0206"
    VanishingGradient "FDC0301"
    Repelling "FDC0302"
    OtherCoordinates "FDC0303"
    NotContracting "FDC0304"
    StartOnSurface "FDC0305"
    ControlJumps "FDC0306"
    EndlessJumps "FDC0310"
    IdleJump "FDC0311"
    EmptyBounds "FDC0401"
    NoDuration "FDC0402"
    NoBoundary "FDC0403"
    Unused "FDC0404"
    NoEquation "FDC0405"
    NotSmooth "FDC0406"
    NoTime "FDC0407"
    NoValue "FDC0408"
    GuessOutside "FDC0409"
    LongStep "FDC0501"
    SweepTooSlow "FDC0502"
    NoRoom "FDC0503"
    Scales "FDC0504"
    NotFinite "FDC0601"
    Infeasible "FDC0602"
    NotYet "FDC0603"
    UnitMismatch "FDC0701"
    UnitHere "FDC0702"
    UnitOfPower "FDC0703"
    BareNumber "FDC0704"
}
