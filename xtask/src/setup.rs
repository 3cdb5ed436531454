pub fn setup() -> Result<(), String> { Ok(()) }
