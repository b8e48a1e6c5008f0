// SPDX-License-Identifier: Apache-2.0
#include "app/job.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "app/checkpoint.h"
#include "app/choose_isa.h"
#include "app/disk_space.h"
#include "app/join_parts.h"
#include "app/layers.h"
#include "app/matte_manifest.h"
#include "app/memory.h"
#include "app/output_files.h"
#include "app/picture_header.h"
#include "app/provenance.h"
#include "app/statistics.h"
#include "app/text.h"
#include "app/threads.h"
#include "app/working_space.h"
#include "base/error.h"
#include "base/exit_status.h"
#include "compile/compile.h"
#include "film/layer_film.h"
#include "format/read_scene.h"
#include "image/format.h"
#include "image/verify.h"
#include "kernel/isa.h"

namespace orrery::app {
namespace {

/// Seconds since the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

bool wants_display(const Job& job) {
  for (const auto& output : job.outputs)
    if (image::is_display_format(image::format_of(output))) return true;
  return false;
}

render::Traversal traversal_of(const Job& job) {
  if (job.traversal == "auto") return render::Traversal::kAuto;
  if (job.traversal == "packet") return render::Traversal::kPacket;
  if (job.traversal == "single") return render::Traversal::kSingle;
  throw base::Error(base::ErrorKind::kUsage, "no traversal " + job.traversal + "; there are auto, packet and single");
}

/// A part is sums and nothing else: pictures are made of all parts together.
void check_part(const Job& job) {
  const auto refuse = [](const std::string& text) { throw base::Error(base::ErrorKind::kUsage, text); };
  if (job.outputs.size() > 1 || image::format_of(job.outputs.front()) != image::Format::kExr || !job.deep.empty())
    refuse("--samples A:B and --tiles render a part, which is one EXR; orrery merge makes pictures of the parts");
  if (job.noise > 0 || job.seconds > 0)
    refuse("--noise and --time decide by the whole picture; a part, by --samples A:B or --tiles, has a fixed share");
}

/// Everything that can be known to fail before hours are spent, but for the scene.
void check_request(const Job& job) {
  std::vector<std::filesystem::path> others;
  if (!job.statistics.empty()) others.push_back(job.statistics);
  if (!job.deep.empty()) others.push_back(job.deep);
  if (job.parts.empty()) others.push_back(checkpoint_file(job.outputs.front()));
  if (is_part(job)) check_part(job);
  if (!job.deep.empty() && image::format_of(job.deep) != image::Format::kExr)
    throw base::Error(base::ErrorKind::kUsage, job.deep.string() + " cannot hold samples in depth; EXR can");
  std::vector<std::filesystem::path> inputs = {job.scene};
  for (const PartFile& part : job.parts) inputs.push_back(part.file);
  check_output_files(job.outputs, job.bits, others, inputs);
  traversal_of(job);
  image::check_compression(job.exr.compression);
  choose_isa(job.isa);
}

[[noreturn]] void stopped(const std::string& remedy = "") {
  throw base::Error(base::ErrorKind::kStopped, "stopped; no picture was written" + remedy);
}

void stop_if_asked(const Job& job) {
  if (job.cancel != nullptr && job.cancel->load(std::memory_order_relaxed)) stopped();
}

void warn(const Job& job, const base::Finding& finding) {
  if (job.on_warning) job.on_warning(finding);
}

void require_bits(const display::Choice& display, const Job& job) {
  for (const auto& output : job.outputs) {
    const image::Format format = image::format_of(output);
    if (display.is_hdr && image::is_display_format(format) && image::most_bits(format) < 16)
      throw base::Error(base::ErrorKind::kUsage, output.string() + " holds 8 bits in a channel, too few for display " +
                                                     display.display + "; PNG and TIFF hold 16");
  }
}

/// The display that display formats are developed for; nothing is looked up where there is none.
display::Settings choose_display(const Job& job, const scene::Scene& scene, JobReport& report) {
  display::Settings display = job.display;
  const scene::Color& color = scene.color;
  const auto otherwise = [](std::string& flag, const std::string& key) {
    if (flag.empty()) flag = key;
  };
  otherwise(display.config, config_of(job.scene, color));
  otherwise(display.display, color.display);
  otherwise(display.view, color.view);
  otherwise(display.look, color.look);
  if (!display.exposure) display.exposure = color.exposure;
  display.working_space = color.working_space();
  if (!wants_display(job)) return display;
  report.display = display::choose(display);
  require_bits(report.display, job);
  for (const std::string& text : report.display.warnings) {
    base::Finding finding;
    finding.severity = base::Severity::kWarning;
    finding.file = report.display.config;
    finding.text = text;
    warn(job, finding);
  }
  return display;
}

void write_outputs(const Job& job, const display::Settings& display, const film::Picture& picture,
                   const image::Header& header, const std::vector<MatteNames>& mattes, JobReport& report) {
  std::optional<film::EncodedPicture> developed;  // once for all display formats
  const auto add = [&](const image::WriteReport& one) {
    report.written.clamped += one.clamped;
    report.written.not_finite += one.not_finite;
  };
  for (const auto& output : job.outputs) {
    switch (image::format_of(output)) {
      case image::Format::kExr: {
        image::Header own = header;
        own.matte_attributes = matte_attributes(mattes, output);
        write_manifests(mattes, output);  // first: no picture shall name a file that is not there
        add(image::write_exr(output, picture, own, job.exr));
        break;
      }
      case image::Format::kHdr: add(image::write_hdr(output, picture)); break;
      case image::Format::kPng:
      case image::Format::kTiff:
      case image::Format::kJpeg:
      case image::Format::kPpm:
        if (!developed)
          developed = display::develop(picture, display, job.bits != 0 ? job.bits : report.display.default_bits());
        image::write_encoded(output, *developed, header.software, header.stamp);
        break;
    }
  }
}

/// The layers that some file of the job will hold; what no file holds is not computed.
Layers layers_for(const Job& job, const scene::Scene& scene, const compile::World& world) {
  Layers layers = choose_layers(scene, world);
  layers.request.deep = !job.deep.empty();
  image::check_lossless(film::planes_of(layers.request), job.exr);
  const auto is_exr = [](const auto& file) { return image::format_of(file) == image::Format::kExr; };
  if (std::any_of(job.outputs.begin(), job.outputs.end(), is_exr)) return layers;
  const auto is_explicit = [](const std::string& setting) { return setting.rfind("output.layers=", 0) == 0; };
  if (!scene.output.layers.empty() && std::any_of(job.overrides.begin(), job.overrides.end(), is_explicit))
    throw base::Error(base::ErrorKind::kUsage, "layers were asked for, and no output can hold them; add -o FILE.exr");
  Layers none;
  none.request.coverage = layers.request.coverage;
  none.request.deep = layers.request.deep;
  return none;
}

void count_bad_values(const film::Picture& picture, JobReport& report) {
  for (const film::Plane& plane : picture.planes) {
    const film::BadValues bad = film::count_bad_values(plane);
    if (!bad.any()) continue;
    report.bad_values += bad;
    const std::string layer = plane.layer().empty() ? "beauty" : plane.layer();
    if (report.bad_layers.empty() || report.bad_layers.back().first != layer) report.bad_layers.push_back({layer, {}});
    report.bad_layers.back().second += bad;
  }
}

/// What can be seen of a picture so far.
film::Picture preview(const compile::World& world, const film::Partial& partial) {
  film::Partial shown(0, 0);
  shown.film = partial.film;
  shown.second = partial.second;
  return render::finished(world, {}, std::move(shown)).picture;
}

/// When to stop sampling. The samples of the scene limit what is asked for otherwise only if they were asked for, too.
void set_target(const Job& job, double seconds_so_far, render::Settings& settings) {
  constexpr double kLeastTime = 1e-3;  // nothing left is not no limit
  settings.noise = job.noise;
  if (job.seconds > 0) settings.seconds = std::max(job.seconds - seconds_so_far, kLeastTime);
  settings.unlimited = !is_limited(job);
}

std::string missed_target(const Job& job, const render::Statistics& statistics) {
  std::string out;
  if (job.noise > 0 && statistics.noise && *statistics.noise > job.noise)
    append(out, "noise %.3g instead of %.3g: %s", *statistics.noise, job.noise,
           statistics.ended_by == "time" ? "time was over" : "every pixel that needs more has had all its samples");
  return out;
}

MemoryEstimate memory_for(const Job& job, const compile::World& world, const film::LayerRequest& layers) {
  MemoryEstimate memory = estimate_memory(world.width, world.height, film::planes_of(layers).size(),
                                          world.spheres.size(), world.accelerator == compile::Accelerator::kEmbree);
  memory.film += estimate_state(world.width, world.height, job.noise > 0 || job.seconds > 0, layers.any());
  return memory;
}

void check_samples(const Job& job, const compile::World& world) {
  if (job.sample_end > static_cast<std::uint32_t>(world.samples))
    throw base::Error(base::ErrorKind::kUsage,
                      "--samples " + std::to_string(job.sample_begin) + ":" + std::to_string(job.sample_end) +
                          " goes beyond the scene's " + std::to_string(world.samples) +
                          " samples; --set render.samples=" + std::to_string(job.sample_end) + " gives it more");
}

/// Adds up the parts instead of rendering.
render::Result join(const Job& job, const compile::World& world, const Layers& layers,
                    const image::Provenance& provenance, JobReport& report) {
  const PartFile& first = job.parts.front();
  if (const std::string wrong = difference(first.provenance, provenance, {"version", "sceneHash", "layers"});
      !wrong.empty())
    throw base::Error(base::ErrorKind::kBadData, first.file.string() + " is of " + wrong + ", which " +
                                                     job.scene.string() +
                                                     " comes to now; the scene has changed, or --scene names another");
  Joined joined = join_parts(job.parts, world.width, world.height, static_cast<std::uint32_t>(world.samples),
                             world.spheres.size(), job.allow_missing);
  report.missing = joined.missing;
  report.hosts = joined.hosts;
  const film::Effort effort = joined.partial.effort;
  const auto [fewest, most] = std::minmax_element(joined.partial.counts.begin(), joined.partial.counts.end());
  render::Statistics statistics;
  statistics.fewest_samples = *fewest;
  statistics.most_samples = *most;
  statistics.paths = effort.paths;
  statistics.rays = effort.rays;
  statistics.bad_samples = effort.bad_samples;
  statistics.render_s = effort.seconds;
  statistics.ended_by = "samples";
  if (!layers.request.any()) joined.partial.layers.clear();
  if (joined.partial.layers.empty() && layers.request.any())
    throw base::Error(base::ErrorKind::kBadData, "the parts were rendered without the layers that are asked for");
  render::Result result = render::finished(world, layers.request, std::move(joined.partial));
  result.statistics = statistics;
  return result;
}

/// Whether all files of a job are there, whole, and what it would write again.
bool is_there(const Job& job, const compile::World& world, const image::Provenance& provenance,
              const std::string& stamp) {
  if (is_part(job)) {
    try {
      const image::PartialFile part = image::read_partial(job.outputs.front(), world.width, world.height);
      return difference(part.provenance, provenance, keys_of_checkpoints()).empty() && is_finished(part);
    } catch (const base::Error&) {
      return false;
    }
  }
  const auto is_same = [&](const std::filesystem::path& file) { return image::verified_stamp(file) == stamp; };
  return std::all_of(job.outputs.begin(), job.outputs.end(), is_same) && (job.deep.empty() || is_same(job.deep));
}

/// Renders, going on from a checkpoint where there is one, and leaves one behind where it is stopped.
render::Result render(const Job& job, const compile::World& world, render::Settings settings, Checkpoint& checkpoint,
                      JobReport& report) {
  settings.sample_begin = job.sample_begin;
  settings.sample_end = job.sample_end;
  settings.share = job.share;
  settings.keep_partial = is_part(job);
  settings.snapshot_is_due = [&] { return checkpoint.is_due(); };
  settings.on_snapshot = [&](const film::Partial& partial) { checkpoint.write_snapshot(partial); };
  std::optional<film::Partial> from = checkpoint.load(world.width, world.height);
  report.was_resumed = from.has_value();
  render::Result result = render::render(world, settings, std::move(from));
  report.render = result.statistics;
  report.phases.build_s = result.statistics.build_s;
  report.phases.render_s = result.statistics.render_s;
  if (result.completed) return result;
  if (!result.partial) stopped();
  checkpoint.write(*result.partial);
  report.checkpoint = checkpoint.file();
  stopped("; " + checkpoint.file().string() + " keeps what was rendered, and --resume goes on from there");
}

/// The way data takes.
void run_phases(const Job& job, JobReport& report) {
  Stopwatch watch, total;
  format::ReadResult read = format::read_scene(job.scene, job.overrides, job.frame);
  for (const base::Finding& warning : read.warnings) warn(job, warning);
  const display::Settings display = choose_display(job, read.scene, report);
  if (const int moved = to_working_space(display.config, read.scene); moved > 0) {
    base::Finding finding;
    finding.severity = base::Severity::kWarning;
    finding.file = job.scene.string();
    finding.text = std::to_string(moved) + " colours are out of range in " + read.scene.color.working_space() +
                   " and were moved to its edge";
    warn(job, finding);
  }
  report.phases.read_s = watch.lap();
  stop_if_asked(job);

  const compile::World world = compile::compile(read.scene, read.closing ? &*read.closing : nullptr);
  check_samples(job, world);
  const Layers layers = layers_for(job, read.scene, world);
  const image::Provenance provenance = provenance_of(job, world, layers);
  const std::string stamp = stamp_of(job, provenance, display);
  report.scene_hash = provenance.at("sceneHash");
  report.was_skipped = job.skip_existing && is_there(job, world, provenance, stamp);
  if (report.was_skipped) return;
  require_disk_space(job, world, film::planes_of(layers.request).size());
  require_memory(memory_for(job, world, layers.request), job.memory_limit);
  read.scene.points = {};  // ten million spheres need not be there twice while the tree is built
  report.hosts = {provenance.at("host")};
  report.width = world.width;
  report.height = world.height;
  report.spheres = world.spheres.size();
  report.phases.compile_s = watch.lap();
  stop_if_asked(job);

  render::Settings settings;
  settings.threads = job.threads > 0 ? job.threads : default_threads();
  settings.traversal = traversal_of(job);
  settings.layers = layers.request;
  settings.on_progress = job.on_progress;
  settings.on_build = job.on_build;
  settings.cancel = job.cancel;
  set_target(job, total.lap(), settings);
  image::set_threads(settings.threads);
  const auto write_sums = [&](const std::filesystem::path& file, const film::Partial& partial) {
    image::write_partial(file, preview(world, partial), picture_header(read, world, report, job.reproducible),
                         provenance, partial);
  };
  Checkpoint checkpoint(job, provenance, write_sums);
  const render::Result result = job.parts.empty() ? render(job, world, settings, checkpoint, report)
                                                  : join(job, world, layers, provenance, report);
  report.render = result.statistics;
  watch.lap();

  report.target_missed = missed_target(job, result.statistics);
  count_bad_values(result.picture, report);
  if (is_part(job)) {
    write_sums(job.outputs.front(), *result.partial);
  } else {
    image::Header header = picture_header(read, world, report, job.reproducible);
    header.stamp = stamp;
    write_outputs(job, display, result.picture, header, layers.mattes, report);
    if (!job.deep.empty()) image::write_deep(job.deep, result.deep, result.picture, header);
  }
  checkpoint.remove();
  report.phases.write_s = watch.lap();
}

/// What went wrong is written down as far as that still works; the error itself is what the caller shall hear.
void write_failure(const Job& job, const JobReport& report, const base::Error& error) {
  if (job.statistics.empty()) return;
  const bool stopped = error.kind() == base::ErrorKind::kStopped;
  try {
    write_statistics(job.statistics, report,
                     {stopped ? "stopped" : "failed", base::exit_status(error.kind()), error.what()});
  } catch (const base::Error&) {
  }
}

}  // namespace

bool is_limited(const Job& job) {
  const auto is_samples = [](const std::string& setting) { return setting.rfind("render.samples=", 0) == 0; };
  return std::any_of(job.overrides.begin(), job.overrides.end(), is_samples);
}

JobReport run_job(const Job& job) {
  check_request(job);
  JobReport report;
  try {
    run_phases(job, report);
  } catch (const base::Error& error) {
    write_failure(job, report, error);
    throw;
  }
  if (!job.statistics.empty()) write_statistics(job.statistics, report, {});
  return report;
}

}  // namespace orrery::app
