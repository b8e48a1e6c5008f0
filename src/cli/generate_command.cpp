// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/commands.h"
#include "generate/generate.h"
#include "scene/limits.h"
#include "scene/scene.h"
#include "scene/value_text.h"

namespace orrery::cli {
namespace {

struct GenerateOptions {
  generate::FinalScene final_scene;
  generate::Cloud cloud;
  std::uint64_t planet_seed = 1;
  std::string environment;
  int width = generate::kEnvironmentWidth;
  scene::Background sky;
  double ground_albedo = 0.2;
  bool no_sun = false;
  std::filesystem::path output;
  bool force = false;
  bool quiet = false;  ///< no generator prints anything but errors
};

constexpr std::uint64_t kMaxSeed = std::numeric_limits<std::uint64_t>::max();

/// Adds the options of all generators. None prints anything but errors; -q is the option that other commands have.
void add_common(Command& command, GenerateOptions& options, const char* what) {
  command.add_option("-o,--output", options.output, "FILE", what)->required();
  command.add_flag("-q,--quiet", options.quiet, "Print only errors, which is the default");
}

void add_scene_options(Command& command, GenerateOptions& options) {
  add_common(command, options, "Scene file to write");
  command.add_flag("--force", options.force, "Replace a scene file that was edited, or not written by orrery")
      ->details("Without it, the exit status is 73.");
}

void add_seed(Command& command, std::uint64_t& seed) {
  command.add_option("--seed", seed, "N", "Random seed; default: 1")->transform(whole_number(0, kMaxSeed));
}

void add_map_options(Command& command, GenerateOptions& options) {
  add_common(command, options, "EXR file to write");
  command
      .add_option("--width", options.width, "PX",
                  "Image width in pixels, a multiple of 4; the height is half of it; default: " +
                      std::to_string(generate::kEnvironmentWidth))
      ->transform(whole_number(generate::kSmallestEnvironment, generate::kLargestEnvironment));
}

void add_final(Command& generate, const std::shared_ptr<GenerateOptions>& options) {
  Command& command = *generate.add_subcommand("final", "The random final scene of Ray Tracing in One Weekend");
  add_scene_options(command, *options);
  add_seed(command, options->final_scene.seed);
  command
      .add_option("--grid", options->final_scene.grid, "N",
                  "Grid cells from the centre to the edge, 0 to 1000; default: 11")
      ->details("As in the book. Above 32, the spheres are written to a PLY file.")
      ->transform(whole_number(0, generate::kLargestFinalGrid));
  command
      .add_flag(
          "--moving", options->final_scene.moving,
          "Generate the variant in The Next Week: checkered ground, small spheres that move while the shutter is open")
      ->details("The grid is then at most 32.");
  command.footer(
      "Examples:\n"
      "  orrery generate final -o final.toml --seed 7\n"
      "  orrery generate final --moving -o bouncing.toml");
  command.act([options] { generate::generate_final(options->final_scene, options->output, options->force); });
}

void add_cloud(Command& generate, const std::shared_ptr<GenerateOptions>& options) {
  Command& command =
      *generate.add_subcommand("cloud", "A cloud of small spheres: a scene file and a PLY file next to it");
  add_scene_options(command, *options);
  add_seed(command, options->cloud.seed);
  command.add_option("--count", options->cloud.count, "N", "Number of spheres; default: 1000")
      ->transform(whole_number(1, generate::kLargestCloud));
  command
      .add_option("--radius", options->cloud.radius, "R",
                  "Radius of all spheres, in scene units; default: random, with a mean that depends on --count")
      ->check(real_number(0, generate::kLargestCloudRadius));
  command.details("An existing PLY file is replaced only if orrery wrote it; otherwise the exit status is 73.");
  command.footer("Example:\n  orrery generate cloud -o cloud.toml --count 1000000");
  command.act([options] { generate::generate_cloud(options->cloud, options->output, options->force); });
}

constexpr const char* kSkyHeading = "Options of sky";

/// Adds the options of daylight skies.
void add_sky_options(Command& command, GenerateOptions& options) {
  const OptionGroup group(command, kSkyHeading);
  scene::Background& sky = options.sky;
  options.ground_albedo = sky.ground_albedo.x;
  command
      .add_option("--sun-elevation", sky.sun_elevation, "DEG",
                  "Sun elevation above the horizon, in degrees; default: " + scene::number_text(sky.sun_elevation))
      ->check(real_number(-90, 90));
  command
      .add_option("--sun-azimuth", sky.sun_azimuth, "DEG",
                  "Sun azimuth in degrees, from +z towards +x; default: " + scene::number_text(sky.sun_azimuth))
      ->check(real_number(-scene::kLargestRotation, scene::kLargestRotation));
  command
      .add_option("--turbidity", sky.turbidity, "T",
                  "Turbidity, 1 (pure air) to 10 (hazy); default: " + scene::number_text(sky.turbidity))
      ->check(real_number(scene::kLowestTurbidity, scene::kHighestTurbidity));
  command
      .add_option("--ground-albedo", options.ground_albedo, "A",
                  "Ground albedo, 0 to 1; default: " + scene::number_text(options.ground_albedo))
      ->check(real_number(0, 1));
  command.add_flag("--no-sun", options.no_sun, "Omit the sun's disc");
}

void add_env(Command& generate, const std::shared_ptr<GenerateOptions>& options) {
  Command& command =
      *generate.add_subcommand("env", "A latitude-longitude environment map: a photo studio, or daylight");
  command.add_option("KIND", options->environment, "NAME", "studio or sky")->required()->choices({"studio", "sky"});
  add_map_options(command, *options);
  add_sky_options(command, *options);
  command.details(
      "Scene-linear Rec.709, for a background of type image. studio: a photo studio around a ball at the origin, for "
      "material tests, with the camera at +z. A key light at the left of the camera has radiance 18 in its centre, a "
      "fill light at the right 3, a strip behind the ball 25, and an overhead light 4; soft boxes are 40 % darker in "
      "their corners. The walls are dark, the floor is grey. A white surface that faces the key light has radiance "
      "1.1. sky: the daylight sky of a background of type sky, including the sun.");
  command.footer(
      "Examples:\n"
      "  orrery generate env studio -o studio.exr\n"
      "  orrery generate env sky -o evening.exr --sun-elevation 4 --sun-azimuth -60");
  command.act([options, &command] {
    const std::vector<std::string> of_sky =
        command.arguments([](const Option& option) { return option.heading() == kSkyHeading; });
    if (options->environment != "sky" && !of_sky.empty()) base::refuse(of_sky.front() + " is an option of `sky`");
    if (options->environment == "studio") return generate::generate_studio(options->width, options->output);
    options->sky.sun = !options->no_sun;
    options->sky.ground_albedo = math::Vec3d{1, 1, 1} * options->ground_albedo;
    generate::generate_sky(options->sky, options->width, options->output);
  });
}

void add_planet(Command& generate, const std::shared_ptr<GenerateOptions>& options) {
  Command& command = *generate.add_subcommand("planet", "A planet map for textures: continents, ice and clouds");
  add_map_options(command, *options);
  add_seed(command, options->planet_seed);
  command.details("The map holds reflectance, scene-linear Rec.709, for textures of type image.");
  command.footer("Example:\n  orrery generate planet -o planet.exr --width 2048");
  command.act([options] { generate::generate_planet(options->planet_seed, options->width, options->output); });
}

}  // namespace

void add_generate(Command& program) {
  const auto options = std::make_shared<GenerateOptions>();
  Command& command = *program.add_subcommand("generate", "Generate a scene file, an environment map or a texture");
  command.require_subcommand();
  add_final(command, options);
  add_cloud(command, options);
  add_env(command, options);
  add_planet(command, options);
  command.footer(
      "Examples:\n"
      "  orrery generate final -o final.toml --seed 7\n"
      "  orrery generate cloud -o cloud.toml --count 1000000\n"
      "  orrery generate env studio -o studio.exr\n"
      "  orrery generate planet -o planet.exr");
}

}  // namespace orrery::cli
