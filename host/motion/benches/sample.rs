//! A crowd: 1000 figures of 15 links and 12 keys, each with its own keys and kinetics, placed at random
//! times and forwards. Criterion's throughput is links; the aim is under 60 ns each on one core.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use motion::{
    Clip, DirectionLaw, Figure, FigureKey, FigurePose, Keyframes, KineticsMode, LinkPose, LinkSpec, Placed,
    TwistLaw,
};
use std::hint::black_box;
use std::sync::Arc;

const FIGURES: usize = 1000;
const LINKS: usize = 15;
const KEYS: usize = 12;

/// Parents of the thesis's figure, by number.
const PARENTS: [usize; LINKS] = [0, 0, 1, 2, 3, 1, 5, 6, 1, 8, 9, 10, 8, 12, 13];

/// A reproducible stream of numbers in 0..1 (splitmix64), so that no crate is needed for chance.
struct Stream(u64);

impl Stream {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn signed(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }
}

fn figure() -> Arc<Figure> {
    let specs: Vec<LinkSpec> = (0..LINKS)
        .map(|number| LinkSpec {
            number: number as u32,
            name: String::new(),
            dof: 2 + (number % 2) as u32,
            length: 0.2,
            children: (1..LINKS)
                .filter(|&child| PARENTS[child] == number)
                .map(|child| (child as u32, DVec3::new(0.05, 0.0, 0.2)))
                .collect(),
        })
        .collect();
    Arc::new(Figure::new(&specs).expect("the thesis's figure").0)
}

fn clip(figure: &Arc<Figure>, chance: &mut Stream, direction_law: DirectionLaw, twist_law: TwistLaw) -> Clip {
    let mut secs = 0.0;
    let keys = (0..KEYS)
        .map(|_| {
            secs += 0.3 + chance.next() * 0.5;
            let links = (0..LINKS)
                .map(|_| LinkPose {
                    direction: DVec3::new(chance.signed(), chance.signed(), chance.signed() + 0.01),
                    twist_rad: 3.0 * chance.signed(),
                    length: 0.2,
                })
                .collect();
            let root = DVec3::new(chance.signed(), chance.signed(), chance.signed());
            FigureKey {
                secs,
                pose: FigurePose { root, links },
            }
        })
        .collect();
    let empty = Keyframes::new(Arc::clone(figure));
    Clip::build(&Keyframes {
        keys,
        direction_law,
        twist_law,
        kinetics: KineticsMode::Natural,
        ..empty
    })
    .expect("random keys are sound")
}

fn crowd(bench: &mut Criterion) {
    let figure = figure();
    let cases = [
        ("constant transport", DirectionLaw::Constant, TwistLaw::Transport),
        ("chord transport", DirectionLaw::Chord, TwistLaw::Transport),
        ("constant zyz", DirectionLaw::Constant, TwistLaw::Zyz),
    ];
    let mut group = bench.benchmark_group("crowd");
    group
        .throughput(Throughput::Elements((FIGURES * LINKS) as u64))
        .sample_size(20);
    for (name, direction_law, twist_law) in cases {
        let mut chance = Stream(1);
        let clips: Vec<Clip> = (0..FIGURES)
            .map(|_| clip(&figure, &mut chance, direction_law, twist_law))
            .collect();
        let mut placed: Vec<Placed> = Vec::new();
        group.bench_function(format!("{name}, random time"), |b| {
            b.iter(|| {
                for clip in &clips {
                    clip.place(chance.next() * 7.0, &mut placed);
                    black_box(&placed);
                }
            });
        });
        let mut secs = 0.0;
        group.bench_function(format!("{name}, forwards"), |b| {
            b.iter(|| {
                secs = (secs + 1.0 / 30.0) % 7.0;
                for (offset, clip) in clips.iter().enumerate() {
                    clip.place((secs + offset as f64 * 0.01) % 7.0, &mut placed);
                    black_box(&placed);
                }
            });
        });
    }
    group.finish();
}

/// The latency of dragging one key: solving a channel of 1000 keys again.
fn edit(bench: &mut Criterion) {
    let mut chance = Stream(2);
    let abscissae: Vec<f64> = (0..1000).map(f64::from).collect();
    let values: Vec<f64> = abscissae.iter().map(|_| chance.signed()).collect();
    bench.bench_function("solve 1000 keys", |b| {
        b.iter(|| motion::Natural::new(black_box(&abscissae), black_box(&values)));
    });
}

criterion_group!(benches, crowd, edit);
criterion_main!(benches);
