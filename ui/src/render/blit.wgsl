// One triangle that covers everything and shows a picture of the same size.

@group(0) @binding(0) var picture: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
  let corner = vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u));
  return vec4<f32>(corner.x * 2.0 - 1.0, 1.0 - corner.y * 2.0, 0.0, 1.0);
}

struct Corner { at: vec4<f32> };
@group(0) @binding(1) var<uniform> corner: Corner;

@fragment
fn fragment(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
  // Pixel for pixel: a picture that is blitted half a pixel off is a blurred picture.
  let limit = vec2<i32>(textureDimensions(picture)) - vec2<i32>(1, 1);
  let pixel = clamp(vec2<i32>(at.xy) - vec2<i32>(corner.at.xy), vec2<i32>(0, 0), limit);
  return textureLoad(picture, pixel, 0);
}
