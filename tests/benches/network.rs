//! Messages through the function network: the dial network, chains of 1000 and 100 000, a fan of 1000.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use dialrig_tests::measure::network::Shape;
use std::hint::black_box;

fn tokens(bench: &mut Criterion) {
    let mut group = bench.benchmark_group("network");
    for (name, shape) in [
        ("dials", Shape::dials()),
        ("chain", Shape::chain()),
        ("fan-out", Shape::fan_out()),
        ("long chain", Shape::chain_of(100_000)),
    ] {
        let mut shape = shape.expect("the network loads");
        group.throughput(Throughput::Elements(shape.messages() as u64));
        group.bench_function(name, |b| b.iter(|| black_box(shape.turn())));
    }
    group.finish();
}

criterion_group!(benches, tokens);
criterion_main!(benches);
