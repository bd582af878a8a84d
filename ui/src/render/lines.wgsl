// Lines with round ends, discs, rings and diamonds as instanced quads; the distance to the shape's edge,
// in pixels, becomes coverage, which is what smooths the edge.

struct Target { size: vec2<f32>, pad: vec2<f32> };
@group(0) @binding(0) var<uniform> target_size: Target;

struct Corner {
  @builtin(position) position: vec4<f32>,
  @location(0) pixel: vec2<f32>,
  @location(1) @interpolate(flat) ends: vec4<f32>,
  @location(2) @interpolate(flat) shape: vec4<f32>,
  @location(3) @interpolate(flat) colour: vec4<f32>,
};

// shape: x radius in pixels, y kind (0 line or disc, 1 ring, 2 diamond), z width of a ring's line
@vertex
fn vertex(
  @builtin(vertex_index) index: u32,
  @location(0) ends: vec4<f32>,
  @location(1) shape: vec4<f32>,
  @location(2) colour: vec4<f32>,
) -> Corner {
  let along_full = ends.zw - ends.xy;
  let length_px = length(along_full);
  var along = vec2<f32>(1.0, 0.0);
  if (length_px > 1e-4) { along = along_full / length_px; }
  let across = vec2<f32>(-along.y, along.x);
  let reach = max(shape.x, 0.5) + 1.0;
  let at_end = f32(index & 1u);
  let side = f32((index >> 1u) & 1u) * 2.0 - 1.0;
  let middle = mix(ends.xy - along * reach, ends.zw + along * reach, at_end);
  let pixel = middle + across * side * reach;
  var corner: Corner;
  let unit = pixel / target_size.size;
  corner.position = vec4<f32>(unit.x * 2.0 - 1.0, 1.0 - unit.y * 2.0, 0.0, 1.0);
  corner.pixel = pixel;
  corner.ends = ends;
  corner.shape = shape;
  corner.colour = colour;
  return corner;
}

// Coverage of a band of `width` pixels whose middle is `distance` pixels away; below one pixel it gets
// fainter and not thinner.
fn covered(distance: f32, width: f32) -> f32 {
  let w = max(width, 1.0);
  return clamp(w * 0.5 + 0.5 - distance, 0.0, 1.0) * min(width, 1.0);
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4<f32> {
  let a = corner.ends.xy;
  let b = corner.ends.zw;
  let radius = corner.shape.x;
  let kind = corner.shape.y;
  let p = corner.pixel - a;
  let span = b - a;
  let t = clamp(dot(p, span) / max(dot(span, span), 1e-6), 0.0, 1.0);
  let distance = length(p - span * t);
  if (kind > 1.5) {
    let inside = (abs(p.x) + abs(p.y) - radius) * 0.70710678;
    return vec4<f32>(corner.colour.rgb, clamp(0.5 - inside, 0.0, 1.0));
  }
  if (kind > 0.5) {
    return vec4<f32>(corner.colour.rgb, covered(abs(distance - radius + corner.shape.z * 0.5), corner.shape.z));
  }
  return vec4<f32>(corner.colour.rgb, covered(distance, 2.0 * radius));
}
