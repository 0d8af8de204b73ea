//! The page of each diagnostic, for `fdcc explain` and for editors.

use crate::Code;

/// The pages, read when `fdcc` is built.
macro_rules! pages {
    ($($variant:ident $code:literal)*) => {
        impl Code {
            /// Its page: why it is given, a wrong model and a right one, in Markdown.
            pub fn page(self) -> &'static str {
                match self {
                    $(Code::$variant => include_str!(concat!("../../docs/diagnostics/", $code, ".md")),)*
                }
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
    Bidirectional "FDC0011"
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
    Lookalike "FDC0112"
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
    ConstantSurface "FDC0312"
    EmptyBounds "FDC0401"
    NoDuration "FDC0402"
    NoBoundary "FDC0403"
    Unused "FDC0404"
    NoEquation "FDC0405"
    NotSmooth "FDC0406"
    NoTime "FDC0407"
    NoValue "FDC0408"
    GuessOutside "FDC0409"
    Contradiction "FDC0410"
    NotANumber "FDC0411"
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
