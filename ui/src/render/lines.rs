//! The renderer on a graphics card: every piece of a projected scene is one instance of one quad.
//!
//! Order, colour and depth cue were decided in [`super::flat`], so there is no depth buffer and no
//! multisampling: edges are smoothed in the shader (`lines.wgsl`) from the distance to the shape.

use bytemuck::{Pod, Zeroable};

use super::flat::{Flat, Piece, Shape};
use super::plates::{BoundPlate, PlatePipeline};
use super::raster::ring_width;
use super::scene::Mark;
use super::theme;

/// The format pictures have on the card; colours are stored as the screen takes them.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Instance {
    ends: [f32; 4],
    shape: [f32; 4],
    colour: [f32; 4],
}

const KIND_LINE: f32 = 0.0;
const KIND_RING: f32 = 1.0;
const KIND_DIAMOND: f32 = 2.0;

fn push_instances(piece: &Piece, out: &mut Vec<Instance>) {
    let colour = |c: theme::Rgb| [c.0, c.1, c.2, 255].map(|c| f32::from(c) / 255.0);
    let mut push = |from: [f32; 2], to: [f32; 2], shape: [f32; 3], ink: theme::Rgb| {
        out.push(Instance {
            ends: [from[0], from[1], to[0], to[1]],
            shape: [shape[0], shape[1], shape[2], 0.0],
            colour: colour(ink),
        });
    };
    match piece.shape {
        Shape::Line { from, to, width } => push(from, to, [width / 2.0, KIND_LINE, 0.0], piece.colour),
        Shape::Dot {
            at,
            radius,
            mark: Mark::Disc,
        } => push(at, at, [radius, KIND_LINE, 0.0], piece.colour),
        Shape::Dot {
            at,
            radius,
            mark: Mark::Ring,
        } => {
            push(at, at, [radius, KIND_LINE, 0.0], theme::GROUND);
            push(at, at, [radius, KIND_RING, ring_width(radius)], piece.colour);
        }
        Shape::Dot {
            at,
            radius,
            mark: Mark::Diamond,
        } => {
            push(at, at, [radius, KIND_DIAMOND, 0.0], piece.colour);
        }
    }
}

/// The pipeline; one for all views of a window.
pub struct LinePipeline {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    plates: PlatePipeline,
}

impl LinePipeline {
    /// Compiles the shader for `device`.
    pub fn new(device: &wgpu::Device) -> LinePipeline {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("lines"),
            source: wgpu::ShaderSource::Wgsl(include_str!("lines.wgsl").into()),
        });
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4];
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("lines"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Instance>() as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: &attributes,
                })],
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: FORMAT,
                    blend: Some(wgpu::BlendState::ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        LinePipeline {
            layout: pipeline.get_bind_group_layout(0),
            plates: PlatePipeline::new(device),
            pipeline,
        }
    }
}

/// The instances of one view, kept on the card and grown when needed.
pub struct LineBuffer {
    instances: wgpu::Buffer,
    capacity: usize,
    count: u32,
    /// How many instances lie under the plate.
    under: u32,
    plate: Option<BoundPlate>,
    target: wgpu::Buffer,
    bind: wgpu::BindGroup,
    staging: Vec<Instance>,
}

impl LineBuffer {
    /// An empty view.
    pub fn new(device: &wgpu::Device, pipeline: &LinePipeline) -> LineBuffer {
        let target = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("size of the target"),
            size: 16,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bind = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("lines"),
            layout: &pipeline.layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: target.as_entire_binding(),
            }],
        });
        let capacity = 1024;
        let instances = instance_buffer(device, capacity);
        LineBuffer {
            instances,
            capacity,
            count: 0,
            under: 0,
            plate: None,
            target,
            bind,
            staging: Vec::new(),
        }
    }

    /// Takes over a projected scene for a target of `size` pixels.
    pub fn upload(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        pipeline: &LinePipeline,
        flat: &Flat,
        size: [u32; 2],
    ) {
        self.staging.clear();
        let (under, over) = flat.pieces.split_at(flat.under.min(flat.pieces.len()));
        for piece in under {
            push_instances(piece, &mut self.staging);
        }
        self.under = self.staging.len() as u32;
        for piece in over {
            push_instances(piece, &mut self.staging);
        }
        let plate = flat.plate.as_ref();
        self.plate = plate.and_then(|plate| pipeline.plates.bind(device, queue, plate, size));
        if self.staging.len() > self.capacity {
            self.capacity = self.staging.len().next_power_of_two();
            self.instances = instance_buffer(device, self.capacity);
        }
        self.count = self.staging.len() as u32;
        queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&self.staging));
        let target = [size[0] as f32, size[1] as f32, 0.0, 0.0];
        queue.write_buffer(&self.target, 0, bytemuck::bytes_of(&target));
    }

    /// Draws what was taken over.
    pub fn draw(&self, pipeline: &LinePipeline, pass: &mut wgpu::RenderPass<'_>) {
        self.draw_some(pipeline, pass, 0..self.under);
        if let Some(plate) = &self.plate {
            pipeline.plates.draw(plate, pass);
        }
        self.draw_some(pipeline, pass, self.under..self.count);
    }

    fn draw_some(
        &self,
        pipeline: &LinePipeline,
        pass: &mut wgpu::RenderPass<'_>,
        instances: std::ops::Range<u32>,
    ) {
        if instances.is_empty() {
            return;
        }
        pass.set_pipeline(&pipeline.pipeline);
        pass.set_bind_group(0, &self.bind, &[]);
        pass.set_vertex_buffer(0, self.instances.slice(..));
        pass.draw(0..4, instances);
    }
}

fn instance_buffer(device: &wgpu::Device, capacity: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("lines"),
        size: (capacity * size_of::<Instance>()) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
