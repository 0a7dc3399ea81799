//! The library's sentences in the words of the command line.

use superdeform::options::{Scope, find};
use superdeform::{Error, Warning};

/// How the command line spells an option of the library.
pub fn flag(option: &str) -> String {
    match option {
        "mode" => "--paper".to_string(),
        "limits" => "--no-limits".to_string(),
        "thread_count" => "--threads".to_string(),
        "groups" => "--group".to_string(),
        "bone_groups" => "--groups".to_string(),
        "length_scale" => "--group NAME:length=X".to_string(),
        "thickness_scale" => "--group NAME:thickness=X".to_string(),
        "rig_weights" => "--body-weights".to_string(),
        "rig_garments" => "--garment-weights".to_string(),
        "rig_joints" => "--joints".to_string(),
        "rig" => "--rig auto".to_string(),
        "rig_fingers" => "--no-rig-fingers".to_string(),
        "kinds" => "--body, --garment, --hair, --face-part, --eye, --accessory".to_string(),
        option if find(option).is_some_and(|info| info.scope == Scope::Group) => {
            format!("--group NAME:{option}=X")
        }
        option => format!("--{}", option.replace('_', "-")),
    }
}

fn with_flag(message: &str, option: Option<&str>) -> String {
    option.map_or_else(|| message.to_string(), |option| format!("{message} ({})", flag(option)))
}

/// The sentence of an error.
pub fn sentence(error: Error) -> String {
    with_flag(&error.message, error.option)
}

/// The sentence of an error about the reference, which is read by options of its own.
pub fn sentence_of_reference(error: Error) -> String {
    match error.option {
        Some("humanoid") => format!("{} (--reference-humanoid)", error.message),
        Some("forward" | "kinds") => error.message,
        option => with_flag(&error.message, option),
    }
}

/// Puts the flag that a warning is about into its sentence.
pub fn name_flag(warning: &mut Warning) {
    warning.message = with_flag(&warning.message, warning.option.take());
}

#[cfg(test)]
mod tests {
    use super::*;
    use superdeform::ErrorKind;

    #[test]
    fn a_sentence_ends_with_the_flag_that_it_is_about() {
        let error = |option| Error::new(ErrorKind::BadOption, "no joint").about(option);
        assert_eq!(sentence(error("humanoid")), "no joint (--humanoid)");
        assert_eq!(sentence_of_reference(error("humanoid")), "no joint (--reference-humanoid)");
        assert_eq!(sentence_of_reference(error("forward")), "no joint");
        assert_eq!(sentence(error("hair_length")), "no joint (--hair-length)");
        let mut warning = Warning::new("code", "hair").about("hair_length");
        name_flag(&mut warning);
        name_flag(&mut warning);
        assert_eq!(warning.message, "hair (--hair-length)");
    }
}
