//! The graphics card's pictures: drawn into a target of our own, then shown in somebody's pass or read back.
//!
//! The window's pass belongs to the window: its format and samples differ between a screen and a test. A
//! target of our own looks the same everywhere and needs only to be copied.

use super::flat::{Flat, Viewport};
use super::lines::{FORMAT, LineBuffer, LinePipeline};
use super::picture::Picture;
use super::scene::Scene;
use super::theme;

/// What can go wrong with a graphics card.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// There is none, and no program that imitates one.
    #[error(
        "no graphics adapter was found ({0}); install a driver, or the software one (Debian: mesa-vulkan-drivers)"
    )]
    NoAdapter(String),
    /// It was found but did not start.
    #[error("the graphics adapter did not start: {0}")]
    NoDevice(String),
    /// The picture could not be copied back.
    #[error("the picture could not be read back: {0}")]
    Read(String),
}

/// A picture on the card.
pub struct Texture {
    size: [u32; 2],
    pixels: wgpu::Texture,
    view: wgpu::TextureView,
}

impl Texture {
    /// How colours are stored.
    pub const FORMAT: wgpu::TextureFormat = FORMAT;

    /// A picture of `size` pixels, each side brought between 1 and what the card can do.
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Texture {
        let most = device.limits().max_texture_dimension_2d;
        let size = size.map(|side| side.clamp(1, most));
        let pixels = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d {
                width: size[0],
                height: size[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = pixels.create_view(&wgpu::TextureViewDescriptor::default());
        Texture { size, pixels, view }
    }

    /// Pixels across and down.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// A pass that begins with the ground's colour everywhere.
    pub fn pass<'a>(&self, encoder: &'a mut wgpu::CommandEncoder) -> wgpu::RenderPass<'a> {
        let channel = |c: u8| f64::from(c) / 255.0;
        let ground = theme::GROUND;
        let clear = wgpu::Color {
            r: channel(ground.0),
            g: channel(ground.1),
            b: channel(ground.2),
            a: 1.0,
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.view,
                resolve_target: None,
                depth_slice: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(clear),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..wgpu::RenderPassDescriptor::default()
        })
    }

    /// Copies the picture back into memory; waits for the card.
    pub fn read(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Picture, GpuError> {
        let [width, height] = self.size;
        let pitch = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(pitch) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            self.pixels.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(pitch),
                    rows_per_image: None,
                },
            },
            wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
        );
        queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|e| GpuError::Read(e.to_string()))?;
        let bytes = buffer
            .slice(..)
            .get_mapped_range()
            .map_err(|e| GpuError::Read(e.to_string()))?;
        let row = width as usize * 4;
        let rgba = bytes
            .chunks(pitch as usize)
            .flat_map(|padded| padded[..row].iter().copied())
            .collect();
        Ok(Picture { width, height, rgba })
    }
}

/// One view: its picture on the card, and what is drawn into it.
pub struct Target {
    texture: Texture,
    lines: LineBuffer,
}

impl Target {
    /// An empty picture of `size` pixels.
    pub fn new(device: &wgpu::Device, pipeline: &LinePipeline, size: [u32; 2]) -> Target {
        Target {
            texture: Texture::new(device, size),
            lines: LineBuffer::new(device, pipeline),
        }
    }

    /// The picture.
    pub fn texture(&self) -> &Texture {
        &self.texture
    }

    /// Draws a projected scene over the ground.
    pub fn render(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &LinePipeline,
        flat: &Flat,
    ) {
        self.lines
            .upload((device, queue), pipeline, flat, self.texture.size);
        let mut pass = self.texture.pass(encoder);
        self.lines.draw(pipeline, &mut pass);
    }
}

/// Shows a [`Target`] in somebody else's pass, pixel for pixel.
pub struct Blit {
    pipeline: wgpu::RenderPipeline,
}

/// A target as bound for one [`Blit`].
pub struct Shown {
    bind: wgpu::BindGroup,
    corner: wgpu::Buffer,
}

impl Blit {
    /// For passes whose pictures have the format `onto`.
    pub fn new(device: &wgpu::Device, onto: wgpu::TextureFormat) -> Blit {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("blit"),
            source: wgpu::ShaderSource::Wgsl(include_str!("blit.wgsl").into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("blit"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(onto.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Blit { pipeline }
    }

    /// Binds a target.
    pub fn bind(&self, device: &wgpu::Device, target: &Target) -> Shown {
        let corner = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("corner"),
            size: 16,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bind = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("blit"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&target.texture.view),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: corner.as_entire_binding(),
                },
            ],
        });
        Shown { bind, corner }
    }

    /// Draws a bound target; the pass's scissor or viewport limits it to its rectangle.
    pub fn draw(&self, shown: &Shown, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &shown.bind, &[]);
        pass.draw(0..3, 0..1);
    }
}

impl Shown {
    /// Says where in the pass's picture the target's upper left pixel is.
    pub fn place(&self, queue: &wgpu::Queue, left: u32, top: u32) {
        let at = [left as f32, top as f32, 0.0, 0.0];
        queue.write_buffer(&self.corner, 0, bytemuck::bytes_of(&at));
    }
}

/// A graphics card with no window.
pub struct Headless {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipeline: LinePipeline,
    /// The adapter's name and kind, for reports.
    pub adapter: String,
}

impl Headless {
    /// Starts the first adapter found; `WGPU_BACKEND` chooses among them.
    pub fn start() -> Result<Headless, GpuError> {
        pollster::block_on(async {
            let instance =
                wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
            let adapter = instance
                .request_adapter(&wgpu::RequestAdapterOptions::default())
                .await
                .map_err(|e| GpuError::NoAdapter(e.to_string()))?;
            let (device, queue) = adapter
                .request_device(&wgpu::DeviceDescriptor::default())
                .await
                .map_err(|e| GpuError::NoDevice(e.to_string()))?;
            let info = adapter.get_info();
            let pipeline = LinePipeline::new(&device);
            let adapter = format!("{} ({:?}, {})", info.name, info.device_type, info.backend);
            Ok(Headless {
                device,
                queue,
                pipeline,
                adapter,
            })
        })
    }

    /// The card's two halves, for renderers of one's own.
    pub fn device_and_queue(&self) -> (&wgpu::Device, &wgpu::Queue) {
        (&self.device, &self.queue)
    }

    /// Draws a scene without its labels.
    pub fn draw(&self, scene: &Scene, width: u32, height: u32, scale: f32) -> Result<Picture, GpuError> {
        let mut target = Target::new(&self.device, &self.pipeline, [width, height]);
        let [width, height] = target.texture.size;
        let flat = Flat::new(scene, &Viewport::of_size(width, height).scaled(scale));
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        target.render((&self.device, &self.queue), &mut encoder, &self.pipeline, &flat);
        self.queue.submit([encoder.finish()]);
        target.texture.read(&self.device, &self.queue)
    }
}
