// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <vector>

#include "display/color_space.h"
#include "load/load_images.h"
#include "scene/schema.h"
#include "scene/texture.h"

namespace orrery::load {
namespace {

/// Tolerance for rounding in the conversion.
constexpr double kMatchTolerance = 1e-6;

/// A colour of the scene and the maximum of its components.
struct BoundedColor {
  math::Vec3d* color;
  double maximum;
};

std::vector<BoundedColor> colors_of(scene::Scene& scene) {
  constexpr double kNoLimit = std::numeric_limits<double>::max();
  scene::Background& sky = scene.background;
  std::vector<BoundedColor> out = {{&sky.bottom, kNoLimit}, {&sky.top, kNoLimit}, {&sky.color, kNoLimit}};
  if (sky.backdrop) out.push_back({&*sky.backdrop, kNoLimit});
  for (scene::Material& material : scene.materials)
    std::visit(
        [&](auto& model) {
          if constexpr (requires { model.albedo; }) out.push_back({&model.albedo, 1});
          if constexpr (requires { model.radiance; }) out.push_back({&model.radiance, kNoLimit});
        },
        material.model);
  return out;
}

/// Converts colours in place. Returns the number of colours that were clamped.
int convert(const std::string& ocio, const std::string& from, const std::string& to,
            const std::vector<BoundedColor>& colors) {
  if (colors.empty()) return 0;
  const display::PixelConversion conversion = display::pixel_conversion(ocio, from, to);
  if (!conversion) return 0;
  int clamped = 0;
  for (const auto& [color, maximum] : colors) {
    const math::Vec3d wanted = display::converted(conversion, *color);
    *color = math::least(math::greatest(wanted, {}), math::Vec3d{maximum, maximum, maximum});
    clamped += math::length(*color - wanted) > kMatchTolerance ? 1 : 0;
  }
  return clamped;
}

}  // namespace

std::string config_of(const std::filesystem::path& scene_file, const scene::Color& color) {
  const std::string name = color.config.string();
  return scene::kOcioConfigFile.names_file(name) ? (scene_file.parent_path() / name).string() : name;
}

int to_working_space(const std::string& ocio, scene::Scene& scene) {
  std::vector<BoundedColor> authored = colors_of(scene), rec709;
  for (scene::Points& points : scene.points) {
    for (std::size_t i = 0; i < points.palette.size(); ++i)
      (i < points.palette_rec709 ? rec709 : authored).push_back({&points.palette[i], 1});
  }
  scene::modify_textures(scene, [&](scene::Texture& texture, scene::TextureUse use) {
    if (use == scene::TextureUse::kNumber || texture.type == scene::TextureType::kImage) return;
    const double maximum = use == scene::TextureUse::kRadiance ? std::numeric_limits<double>::max() : 1;
    authored.push_back({&texture.low, maximum});
    authored.push_back({&texture.high, maximum});
  });
  const std::string& working = scene.color.working_space();
  return convert(ocio, scene.color.space, working, authored) + convert(ocio, "lin_rec709", working, rec709);
}

}  // namespace orrery::load
