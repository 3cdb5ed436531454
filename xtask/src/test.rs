pub fn test() -> Result<(), String> { Ok(()) }
