// Filled surfaces, worked out beforehand, laid over what is there pixel for pixel.

struct Place { corner: vec2<f32>, size: vec2<f32>, target_size: vec2<f32>, pad: vec2<f32> };
@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var<uniform> place: Place;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
  let unit = vec2<f32>(f32(index & 1u), f32((index >> 1u) & 1u));
  let at = (place.corner + unit * place.size) / place.target_size;
  return vec4<f32>(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
  let pixel = vec2<i32>(at.xy) - vec2<i32>(place.corner);
  let limit = vec2<i32>(textureDimensions(picture)) - vec2<i32>(1, 1);
  return textureLoad(picture, clamp(pixel, vec2<i32>(0, 0), limit), 0);
}
