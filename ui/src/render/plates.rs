//! Filled surfaces on a graphics card: the processor's [`Plate`] as a picture, laid between the lines under it
//! and those over it.

use super::depth::Plate;
use super::lines::FORMAT;

/// The pipeline; one for all views of a window.
pub(super) struct PlatePipeline {
    pipeline: wgpu::RenderPipeline,
}

/// A plate on the card.
pub(super) struct BoundPlate {
    bind: wgpu::BindGroup,
}

impl PlatePipeline {
    pub(super) fn new(device: &wgpu::Device) -> PlatePipeline {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("plate"),
            source: wgpu::ShaderSource::Wgsl(include_str!("plate.wgsl").into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("plate"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
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
        PlatePipeline { pipeline }
    }

    /// Copies a plate to the card, for a target of `size` pixels.
    pub(super) fn bind(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        plate: &Plate,
        size: [u32; 2],
    ) -> Option<BoundPlate> {
        let most = device.limits().max_texture_dimension_2d;
        if plate.width > most || plate.height > most {
            return None;
        }
        let extent = wgpu::Extent3d {
            width: plate.width,
            height: plate.height,
            depth_or_array_layers: 1,
        };
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("plate"),
            size: extent,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(plate.width * 4),
            rows_per_image: None,
        };
        queue.write_texture(texture.as_image_copy(), &plate.rgba, layout, extent);
        let place = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("place of the plate"),
            size: 32,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let numbers = [
            plate.x,
            plate.y,
            plate.width,
            plate.height,
            size[0],
            size[1],
            0,
            0,
        ];
        queue.write_buffer(&place, 0, bytemuck::bytes_of(&numbers.map(|n| n as f32)));
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let bind = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("plate"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&view),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: place.as_entire_binding(),
                },
            ],
        });
        Some(BoundPlate { bind })
    }

    pub(super) fn draw(&self, plate: &BoundPlate, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &plate.bind, &[]);
        pass.draw(0..4, 0..1);
    }
}
