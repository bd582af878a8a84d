//! Facts about hardware as data: servos, puppets, tablets, knob boxes.
