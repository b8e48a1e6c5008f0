// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "math/vec3.h"
#include "scene/diagnostic.h"
#include "scene/scene.h"

namespace orrery::scene {

/// Returns what is wrong with the exposure of a light; empty if the light is not too bright.
///
/// `radiance`  largest component of the radiance
/// `exposure`  stops
std::string exposure_fault(double radiance, double exposure);

/// Returns what is wrong with a centre and a radius, one text for each; none if the sphere is in the domain.
std::vector<std::string> sphere_faults(math::Vec3d center, double radius, Precision precision);

/// Returns the name of a sphere of a points file for messages: "row 3 of melt.dump", counted from 1; "sphere 3 of
/// melt.dump" if the spheres are not the rows of the file.
///
/// `points`   index into scene.points
/// `index`    of the sphere, from 0
std::string sphere_name(const Scene& scene, std::size_t points, std::size_t index);

/// Checks constraints beyond the type and range of a single key: a camera without direction, a lens that is too large,
/// lights that are too bright, numbers outside the domain, undefined materials, names of light groups, layers that the
/// scene cannot have.
///
/// Domain     any scene, including non-finite numbers
/// Result     empty if the scene is valid; all diagnostics of [[sphere]] tables; the first kMaxReported of each points
///            file, and the number of the others
/// Errors     base::Error(kStopped) in a base::StopScope
/// Cost       linear in the number of spheres
std::vector<SceneDiagnostic> validate(const Scene& scene);

/// Warns of spheres with exactly the same centre and absolute radius as an earlier one, of which only the first is
/// rendered. With `precision = "fast"`, spheres coincide if they are equal in single precision.
///
/// `closing`  the scene at shutter close: spheres that coincide only at shutter open are not counted; null: no motion
/// Result     the first kMaxReported, and the number of the others; empty if there are none
/// Errors     base::Error(kStopped) in a base::StopScope
/// Cost       see base::find_duplicates
std::vector<SceneDiagnostic> warn_of_coincident(const Scene& scene, const Scene* closing);

}  // namespace orrery::scene
