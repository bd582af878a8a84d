//! Colours: the hue wheel, and what a surface sends to the viewer.

use glam::DVec3;

use super::{Light, Material};

/// Red, green and blue, 0 to 1, of a colour of the display tree.
/// Source: `docs/protocols/ps300.md`, "Attributes, conditionals": hexcone hue plus 120.
pub fn rgb(hue_deg: f64, saturation: f64, intensity: f64) -> DVec3 {
    let full = |peak_deg: f64| {
        let away = (hue_deg - peak_deg).rem_euclid(360.0);
        let away = away.min(360.0 - away);
        let pure = ((120.0 - away) / 60.0).clamp(0.0, 1.0);
        let grey = 1.0 - saturation.clamp(0.0, 1.0) * (1.0 - pure);
        grey * intensity.clamp(0.0, 1.0)
    };
    DVec3::new(full(120.0), full(240.0), full(0.0))
}

/// What is left of ambient light where no light says otherwise. Our choice.
const AMBIENT: f64 = 0.25;

/// What a surface with `normal` shows to a viewer in the direction `viewer`, both of length 1, as red,
/// green, blue, 0 to 1: Lambert's law, and Phong's highlight in the colour of the light.
/// Source: B. T. Phong, Illumination for computer generated pictures, 1975; the shares ours.
pub fn shade(material: &Material, lights: &[Light], normal: DVec3, viewer: DVec3) -> DVec3 {
    let from_viewer = [Light {
        towards: viewer,
        colour: DVec3::ONE,
        ambient: AMBIENT,
    }];
    let lights = if lights.is_empty() { &from_viewer } else { lights };
    let mut sum = DVec3::ZERO;
    for light in lights {
        let facing = normal.dot(light.towards);
        let ambient = light.ambient.clamp(0.0, 1.0);
        let lit = ambient + (1.0 - ambient) * facing.max(0.0);
        sum += material.colour * light.colour * (lit * material.diffuse);
        if facing > 0.0 {
            let mirrored = 2.0 * facing * normal - light.towards;
            let shine = mirrored.dot(viewer).max(0.0).powf(material.specular.max(0.0));
            sum += light.colour * (shine * (1.0 - material.diffuse) * (1.0 - ambient));
        }
    }
    sum.clamp(DVec3::ZERO, DVec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wheel_begins_at_blue() {
        for (hue, want) in [
            (0.0, [0.0, 0.0, 1.0]),
            (60.0, [1.0, 0.0, 1.0]),
            (120.0, [1.0, 0.0, 0.0]),
            (180.0, [1.0, 1.0, 0.0]),
            (240.0, [0.0, 1.0, 0.0]),
            (-60.0, [0.0, 1.0, 1.0]),
        ] {
            assert_eq!(rgb(hue, 1.0, 1.0), DVec3::from_array(want), "hue {hue}");
        }
        assert_eq!(rgb(77.0, 0.0, 0.5), DVec3::splat(0.5));
    }

    #[test]
    fn what_faces_the_light_is_brightest_and_what_turns_away_keeps_the_ambient() {
        let dull = Material {
            diffuse: 1.0,
            ..Material::default()
        };
        let light = [Light {
            towards: DVec3::Z,
            colour: DVec3::ONE,
            ambient: 0.2,
        }];
        let seen = |normal| shade(&dull, &light, normal, DVec3::Z).x;
        assert_eq!(seen(DVec3::Z), 1.0);
        assert_eq!((seen(DVec3::X), seen(DVec3::NEG_Z)), (0.2, 0.2));
        let half = (DVec3::Z + DVec3::X * 3.0_f64.sqrt()) / 2.0;
        assert!((seen(half) - 0.6).abs() < 1e-12);
    }

    #[test]
    fn a_mirror_sends_light_one_way() {
        let mirror = Material {
            colour: DVec3::ZERO,
            diffuse: 0.0,
            specular: 1000.0,
            ..Material::default()
        };
        let light = [Light {
            towards: (DVec3::Z + DVec3::X).normalize_or_zero(),
            colour: DVec3::Y,
            ambient: 0.0,
        }];
        let opposite = (DVec3::Z - DVec3::X).normalize_or_zero();
        let seen = shade(&mirror, &light, DVec3::Z, opposite);
        assert!((seen - DVec3::Y).length() < 1e-9, "{seen}");
        assert!(shade(&mirror, &light, DVec3::Z, DVec3::Z).length() < 1e-9);
    }
}
