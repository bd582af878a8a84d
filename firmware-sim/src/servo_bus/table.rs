//! A control table: the servo's memory, and what each byte of it is.
//!
//! The rows come from the servo's profile; indirect data bytes stand for the bytes their addresses name.

use device_profiles::{Access, Area, Register, Role, ServoProfile};

/// Registers the firmware itself works with, by their names in the maker's table.
macro_rules! known_registers {
    ($($variant:ident = $name:literal),* $(,)?) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Reg { $($variant),* }
        impl Reg {
            const ALL: &[(Reg, &str)] = &[$((Reg::$variant, $name)),*];
        }
    };
}

known_registers! {
    ModelNumber = "Model Number",
    FirmwareVersion = "Firmware Version",
    Id = "ID",
    BaudRate = "Baud Rate",
    ReturnDelayTime = "Return Delay Time",
    DriveMode = "Drive Mode",
    OperatingMode = "Operating Mode",
    ShadowId = "Secondary(Shadow) ID",
    HomingOffset = "Homing Offset",
    MovingThreshold = "Moving Threshold",
    TemperatureLimit = "Temperature Limit",
    MaxVoltageLimit = "Max Voltage Limit",
    MinVoltageLimit = "Min Voltage Limit",
    PwmLimit = "PWM Limit",
    CurrentLimit = "Current Limit",
    VelocityLimit = "Velocity Limit",
    StartupConfiguration = "Startup Configuration",
    Shutdown = "Shutdown",
    TorqueEnable = "Torque Enable",
    StatusReturnLevel = "Status Return Level",
    RegisteredInstruction = "Registered Instruction",
    HardwareErrorStatus = "Hardware Error Status",
    VelocityIGain = "Velocity I Gain",
    VelocityPGain = "Velocity P Gain",
    PositionDGain = "Position D Gain",
    PositionIGain = "Position I Gain",
    PositionPGain = "Position P Gain",
    FeedforwardSecond = "Feedforward 2nd Gain",
    FeedforwardFirst = "Feedforward 1st Gain",
    BusWatchdog = "Bus Watchdog",
    GoalPwm = "Goal PWM",
    GoalCurrent = "Goal Current",
    GoalVelocity = "Goal Velocity",
    ProfileAcceleration = "Profile Acceleration",
    ProfileVelocity = "Profile Velocity",
    GoalPosition = "Goal Position",
    RealtimeTick = "Realtime Tick",
    Moving = "Moving",
    MovingStatus = "Moving Status",
    PresentPwm = "Present PWM",
    PresentCurrent = "Present Current",
    PresentLoad = "Present Load",
    PresentVelocity = "Present Velocity",
    PresentPosition = "Present Position",
    VelocityTrajectory = "Velocity Trajectory",
    PositionTrajectory = "Position Trajectory",
    PresentInputVoltage = "Present Input Voltage",
    PresentTemperature = "Present Temperature",
    BackupReady = "Backup Ready",
}

/// An indirect block: `count` addresses of two bytes, and the data bytes that stand for them.
#[derive(Clone, Copy, Debug)]
struct Indirect {
    addresses: u16,
    data: u16,
    count: u16,
}

/// Marks an address that no row covers.
const NO_ROW: u16 = u16::MAX;

/// Memory with its rows.
#[derive(Clone, Debug)]
pub(super) struct Table {
    rows: Vec<Register>,
    row_at: Vec<u16>,
    known: Vec<Option<u16>>,
    indirect: Vec<Indirect>,
    memory: Vec<u8>,
}

impl Table {
    /// A table with factory values throughout.
    pub(super) fn new(profile: &ServoProfile) -> Self {
        let rows = profile.registers.clone();
        let size = profile.table_bytes();
        let mut row_at = vec![NO_ROW; size];
        for (index, row) in (0..).zip(&rows) {
            let start = usize::from(row.address);
            row_at[start..start + usize::from(row.bytes())].fill(index);
        }
        let known = Reg::ALL
            .iter()
            .map(|(_, name)| {
                rows.iter()
                    .position(|row| row.name == *name)
                    .map(|row| row as u16)
            })
            .collect();
        let indirect = rows
            .iter()
            .filter_map(|row| {
                let slots = row.name.strip_prefix("Indirect Address ")?;
                let data = rows
                    .iter()
                    .find(|data| data.name.strip_prefix("Indirect Data ") == Some(slots))?;
                Some(Indirect {
                    addresses: row.address,
                    data: data.address,
                    count: row.count.min(data.count),
                })
            })
            .collect();
        let mut table = Self {
            rows,
            row_at,
            known,
            indirect,
            memory: vec![0; size],
        };
        table.start_values(Area::Eeprom);
        table.start_values(Area::Ram);
        table
    }

    /// Puts every register of `area` to its documented start value, zero where there is none.
    pub(super) fn start_values(&mut self, area: Area) {
        for index in 0..self.rows.len() {
            let row = &self.rows[index];
            if row.area != area {
                continue;
            }
            let (init, step, size, count) = (row.init.unwrap_or(0), row.init_step, row.size, row.count);
            let start = usize::from(row.address);
            for slot in 0..count {
                let at = start + usize::from(slot) * usize::from(size);
                store(
                    &mut self.memory[at..at + usize::from(size)],
                    init + i64::from(slot) * step,
                );
            }
        }
    }

    /// Bytes from the table's start to the end of its EEPROM.
    pub(super) fn eeprom_bytes(&self) -> usize {
        let ends = self.rows.iter().filter(|row| row.area == Area::Eeprom);
        ends.map(|row| usize::from(row.address + row.bytes()))
            .max()
            .unwrap_or(0)
    }

    pub(super) fn memory(&self) -> &[u8] {
        &self.memory
    }

    pub(super) fn memory_mut(&mut self) -> &mut [u8] {
        &mut self.memory
    }

    pub(super) fn row(&self, reg: Reg) -> Option<&Register> {
        self.known[reg as usize].map(|row| &self.rows[usize::from(row)])
    }

    pub(super) fn row_named(&self, name: &str) -> Option<&Register> {
        self.rows.iter().find(|row| row.name == name)
    }

    pub(super) fn row_of(&self, role: Role) -> Option<&Register> {
        self.rows.iter().find(|row| row.role == Some(role))
    }

    /// Which register the firmware knows begins at `address`.
    pub(super) fn known_at(&self, address: u16) -> Option<Reg> {
        let row = *self.row_at.get(usize::from(address))?;
        let known = self
            .known
            .iter()
            .position(|&known| known == Some(row) && row != NO_ROW)?;
        Reg::ALL.get(known).map(|&(reg, _)| reg)
    }

    /// The value of `reg`; zero where the model lacks it.
    pub(super) fn get(&self, reg: Reg) -> i64 {
        self.row(reg).map_or(0, |row| self.value(row))
    }

    /// Stores `value` cut to the register's size; nothing where the model lacks it.
    pub(super) fn set(&mut self, reg: Reg, value: i64) {
        if let Some(row) = self.row(reg) {
            let (at, size) = (usize::from(row.address), usize::from(row.size));
            store(&mut self.memory[at..at + size], value);
        }
    }

    /// The first value of `row`.
    pub(super) fn value(&self, row: &Register) -> i64 {
        let at = usize::from(row.address);
        load(&self.memory[at..at + usize::from(row.size)], row.signed)
    }

    /// The row that covers `address`.
    pub(super) fn row_covering(&self, address: u16) -> Option<&Register> {
        self.rows
            .get(usize::from(*self.row_at.get(usize::from(address))?))
    }

    /// Where a byte really lives: indirect data bytes stand for the byte at their address.
    pub(super) fn resolve(&self, address: u16) -> u16 {
        let block = self
            .indirect
            .iter()
            .find(|block| (block.data..block.data + block.count).contains(&address));
        block.map_or(address, |block| {
            let at = usize::from(block.addresses + 2 * (address - block.data));
            let target = load(&self.memory[at..at + 2], false) as u16;
            if usize::from(target) < self.memory.len() {
                target
            } else {
                address
            }
        })
    }

    pub(super) fn byte(&self, address: u16) -> u8 {
        self.memory
            .get(usize::from(self.resolve(address)))
            .copied()
            .unwrap_or(0)
    }

    /// Whether a host may write `row` at all.
    pub(super) fn is_writable(row: &Register) -> bool {
        row.access == Access::Rw
    }
}

/// Low byte first; two's complement when `signed`.
pub(super) fn load(bytes: &[u8], signed: bool) -> i64 {
    let value = bytes
        .iter()
        .rev()
        .fold(0i64, |value, &byte| value << 8 | i64::from(byte));
    let bits = 8 * bytes.len() as u32;
    if signed && bits > 0 && value >> (bits - 1) & 1 == 1 {
        value - (1 << bits)
    } else {
        value
    }
}

fn store(bytes: &mut [u8], value: i64) {
    let len = bytes.len();
    bytes.copy_from_slice(&value.to_le_bytes()[..len]);
}
