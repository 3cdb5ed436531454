//! A picture as PNG (ISO/IEC 15948): one chunk each for head, data and end.

use egui::ColorImage;

/// Effort of the compression: pictures of plots are mostly plain.
const LEVEL: u8 = 6;

/// The picture as the bytes of a PNG file, 8 bits of red, green and blue a pixel.
pub fn encode(image: &ColorImage) -> Vec<u8> {
    let [width, height] = image.size;
    let mut rows = Vec::with_capacity((3 * width + 1) * height);
    for row in image.pixels.chunks(width.max(1)) {
        // No filter.
        rows.push(0);
        for pixel in row {
            rows.extend([pixel.r(), pixel.g(), pixel.b()]);
        }
    }
    let mut head = Vec::with_capacity(13);
    for size in [width, height] {
        head.extend(u32::try_from(size).unwrap_or(u32::MAX).to_be_bytes());
    }
    // 8 bits a channel, true colour, the usual compression and filters, not interlaced.
    head.extend([8, 2, 0, 0, 0]);
    let data = miniz_oxide::deflate::compress_to_vec_zlib(&rows, LEVEL);
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    for (kind, content) in [(b"IHDR", &head), (b"IDAT", &data), (b"IEND", &Vec::new())] {
        file.extend(u32::try_from(content.len()).unwrap_or(0).to_be_bytes());
        file.extend(kind);
        file.extend(content);
        file.extend(checksum(kind.iter().chain(content)).to_be_bytes());
    }
    file
}

/// The CRC-32 of the standard.
fn checksum<'a>(bytes: impl Iterator<Item = &'a u8>) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            let low = crc & 1;
            crc = (crc >> 1) ^ (0xEDB8_8320 * low);
        }
    }
    !crc
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_the_standard() {
        assert_eq!(checksum(b"123456789".iter()), 0xCBF4_3926);
        assert_eq!(checksum(b"IEND".iter()), 0xAE42_6082);
    }
}
