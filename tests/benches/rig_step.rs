//! One dial report through a whole step of the rig, beside a bare decode of the same bytes.

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use device::Codec;
use dialrig_tests::measure::rig_step::{DialRig, listening_codec};
use std::hint::black_box;

fn rig_step(bench: &mut Criterion) {
    let mut rig = DialRig::new().expect("the shipped show loads");
    let report = rig.turn(3).to_vec();
    let mut codec = listening_codec().expect("the box's profile is built in");
    bench.bench_function("decode a dial report", |b| {
        b.iter(|| {
            codec.decode(black_box(&report), &mut |event| {
                black_box(event);
            });
        });
    });
    let rig = std::cell::RefCell::new(rig);
    bench.bench_function("step with a dial report", |b| {
        b.iter_batched(
            || {
                rig.borrow_mut().turn(3);
            },
            |()| rig.borrow_mut().step(),
            BatchSize::PerIteration,
        );
    });
}

criterion_group!(benches, rig_step);
criterion_main!(benches);
