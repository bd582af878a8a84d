//! USB descriptors, as chapter 9 of the USB 2.0 specification lays them out.

/// Device descriptor of a full-speed device with one configuration and strings 1, 2 and, if asked for, 3.
pub fn device(class: [u8; 3], ids: [u16; 2], release_bcd: u16, serial: bool) -> Vec<u8> {
    let mut bytes = vec![18, 1, 0x00, 0x02, class[0], class[1], class[2], 64];
    for word in [ids[0], ids[1], release_bcd] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend([1, 2, if serial { 3 } else { 0 }, 1]);
    bytes
}

/// Configuration descriptor around `interfaces`, which hold `count` of them.
pub fn configuration(count: u8, interfaces: &[u8]) -> Vec<u8> {
    let total = (9 + interfaces.len()) as u16;
    let [low, high] = total.to_le_bytes();
    // Bus-powered, 100 mA.
    let mut bytes = vec![9, 2, low, high, count, 1, 0, 0x80, 50];
    bytes.extend_from_slice(interfaces);
    bytes
}

/// Interface descriptor.
pub fn interface(number: u8, endpoints: u8, class: [u8; 3]) -> Vec<u8> {
    vec![9, 4, number, 0, endpoints, class[0], class[1], class[2], 0]
}

/// Endpoint descriptor: address with its direction, transfer type, packet size, interval in milliseconds.
pub fn endpoint(address: u8, kind: u8, packet: u16, interval_ms: u8) -> Vec<u8> {
    let [low, high] = packet.to_le_bytes();
    vec![7, 5, address, kind, low, high, interval_ms]
}

/// Transfer type of bulk endpoints.
pub const BULK: u8 = 2;
/// Transfer type of interrupt endpoints.
pub const INTERRUPT: u8 = 3;

/// The strings every device here has.
pub fn usual_string(index: u8, texts: [&str; 3]) -> Option<Vec<u8>> {
    match index {
        0 => Some(vec![4, 3, 0x09, 0x04]),
        1..=3 => Some(firmware_sim::usb_device::string_descriptor(
            texts[usize::from(index) - 1],
        )),
        _ => None,
    }
}
