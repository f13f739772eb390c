//! The command `fieldstone`; everything it does lives in [`fieldstone::cli`].

fn main() -> std::process::ExitCode {
    fieldstone::cli::main()
}
