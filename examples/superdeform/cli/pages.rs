//! Pages about the command line itself: all options, completions for shells, manual pages.

use super::Refusal;
use super::arguments::Single;
use super::batch::Batch;
use clap::{Command, CommandFactory};
use clap_complete::Shell;
use std::ffi::OsString;

/// The options that `-h` shows: what most people give, of a batch too.
const COMMON: [&str; 16] = [
    "output",
    "picture",
    "report",
    "save_style",
    "heads",
    "amount",
    "height",
    "youth",
    "hair_length",
    "rig",
    "verbose",
    "quiet",
    "style",
    "jobs",
    "force",
    "pictures",
];

/// A command whose short help has the common options alone.
pub fn command<T: CommandFactory>() -> Command {
    T::command().mut_args(|argument| {
        let is_common = argument.is_positional() || COMMON.contains(&argument.get_id().as_str());
        let argument = argument.hide_short_help(!is_common);
        // A dozen options are one list.
        if is_common { argument.help_heading(None::<&str>) } else { argument }
    })
}

/// The help with all options, one line each.
pub fn help<T: CommandFactory>() -> String {
    let command = T::command();
    let after = command.get_after_long_help().map(ToString::to_string).unwrap_or_default();
    command.after_help(after).render_help().to_string()
}

/// What `completions SHELL` and `man [batch]` print; `None` for other words.
///
/// # Errors
/// [`Refusal`]: a shell that is not known.
pub fn page(words: &[OsString]) -> Option<Result<Vec<u8>, Refusal>> {
    let word = |index: usize| words.get(index).and_then(|word| word.to_str());
    match (word(1)?, word(2), words.len()) {
        ("completions", Some(shell), 3) => Some(completions(shell)),
        ("man", None, 2) => Some(manual(whole())),
        ("man", Some("batch"), 3) => {
            Some(manual(<Batch as CommandFactory>::command().name("superdeform-batch")))
        }
        _ => None,
    }
}

/// The command with `batch` below it.
fn whole() -> Command {
    Single::command().subcommand(<Batch as CommandFactory>::command().name("batch"))
}

fn completions(shell: &str) -> Result<Vec<u8>, Refusal> {
    let shell: Shell = shell.parse().map_err(|_| {
        Refusal::Usage(format!("{shell} is no shell: name bash, zsh, fish, powershell or elvish"))
    })?;
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut whole(), "superdeform", &mut text);
    Ok(text)
}

fn manual(command: Command) -> Result<Vec<u8>, Refusal> {
    let mut text = Vec::new();
    let rendered = clap_mangen::Man::new(command).render(&mut text);
    rendered.map_err(|error| Refusal::Input(format!("the manual cannot be written: {error}")))?;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(words: &[&str]) -> String {
        let words: Vec<OsString> = words.iter().map(Into::into).collect();
        String::from_utf8(page(&words).unwrap().unwrap()).unwrap()
    }

    #[test]
    fn every_shell_is_told_of_every_option_and_of_the_batch() {
        for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
            let text = text(&["superdeform", "completions", shell]);
            for argument in Single::command().get_arguments().filter_map(|argument| argument.get_long()) {
                assert!(text.contains(argument), "{shell}: {argument}");
            }
            assert!(text.contains("--jobs") || text.contains("jobs"), "{shell}");
        }
        let wrong = ["superdeform", "completions", "dos"].map(Into::into);
        assert!(matches!(page(&wrong), Some(Err(Refusal::Usage(text))) if text.contains("fish")));
    }

    #[test]
    fn manual_pages_hold_every_option() {
        for (words, command) in [
            (&["superdeform", "man"][..], Single::command()),
            (&["superdeform", "man", "batch"], <Batch as CommandFactory>::command()),
        ] {
            let text = text(words);
            assert!(text.starts_with(".ie") && text.contains(".TH"), "{text}");
            for argument in command.get_arguments().filter_map(|argument| argument.get_long()) {
                // A hyphen is a minus there.
                assert!(text.contains(&argument.replace('-', "\\-")), "{argument}");
            }
        }
        // A file of that name is a target as any other.
        let file = ["superdeform", "man", "sd2"].map(Into::into);
        assert!(page(&file).is_none());
    }
}
