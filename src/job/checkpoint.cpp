// SPDX-License-Identifier: Apache-2.0
#include "job/checkpoint.h"

#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/file_name.h"
#include "film/partial.h"
#include "image/partial_file.h"
#include "job/hooks.h"
#include "job/provenance.h"

namespace orrery::job {
namespace {

std::chrono::steady_clock::duration interval(const CheckpointSettings& settings) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(settings.interval_s));
}

}  // namespace

std::filesystem::path checkpoint_file(const std::filesystem::path& first_output) {
  return first_output.parent_path() / base::companion_name(first_output.stem().string(), ".checkpoint.exr");
}

Checkpoint::Checkpoint(std::filesystem::path file, const CheckpointSettings& settings, const Hooks& hooks,
                       image::Provenance provenance, Write write)
    : settings_(settings),
      hooks_(hooks),
      file_(std::move(file)),
      provenance_(std::move(provenance)),
      write_(std::move(write)),
      next_(Clock::now() + interval(settings)) {}

std::optional<film::Partial> Checkpoint::load(int width_px, int height_px) {
  if (!std::filesystem::exists(file_)) return {};
  if (!settings_.resume) {
    if (hooks_.on_warning)
      hooks_.on_warning(base::file_diagnostic(base::Severity::kWarning, file_.string(),
                                              "checkpoint of an earlier render, replaced if this one is stopped; "
                                              "--resume continues from it"));
    return {};
  }
  try {
    const image::Provenance found = image::read_provenance(file_);
    if (const std::string wrong = difference_of_checkpoint(found, provenance_); !wrong.empty())
      throw base::Error(
          base::ErrorKind::kBadData,
          fmt::format("{} has {}; delete it, or render without --resume to start again", file_.string(), wrong));
    image::PartialFile file = image::read_partial(file_, width_px, height_px);
    is_ours_ = true;
    return std::move(file.partial);
  } catch (const base::Error&) {
    // Another process that renders the same image may have finished and removed the checkpoint.
    if (!std::filesystem::exists(file_)) return {};
    throw;
  }
}

bool Checkpoint::is_due() const {
  if (hooks_.snapshot != nullptr && hooks_.snapshot->load(std::memory_order_relaxed)) return true;
  return settings_.interval_s > 0 && Clock::now() >= next_;
}

void Checkpoint::write_snapshot(const film::Partial& partial) {
  const bool was_requested = hooks_.snapshot != nullptr && hooks_.snapshot->exchange(false);
  try {
    write(partial);
    if (was_requested && hooks_.on_note) hooks_.on_note("wrote " + file_.string());
  } catch (const base::Error& error) {
    if (hooks_.on_warning)
      hooks_.on_warning(base::file_diagnostic(base::Severity::kWarning, file_.string(),
                                              std::string("checkpoint not written: ") + error.what()));
  }
  next_ = Clock::now() + interval(settings_);
}

void Checkpoint::write(const film::Partial& partial) {
  write_(file_, partial);
  is_ours_ = true;
}

void Checkpoint::finish(const film::Partial* partial) {
  if (settings_.keep && partial != nullptr) return write_snapshot(*partial);
  std::error_code ignored;
  if (is_ours_) std::filesystem::remove(file_, ignored);
}

}  // namespace orrery::job
