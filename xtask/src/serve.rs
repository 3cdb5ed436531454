pub fn forever(_p: u16) -> Result<(), String> { Ok(()) }
