//! Simulated devices behind the rig's ports, and the scenario runner.
