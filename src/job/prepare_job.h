// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "annotation/drawing.h"
#include "base/file_set.h"
#include "base/stopwatch.h"
#include "compile/compiled_scene.h"
#include "image/header.h"
#include "job/job.h"
#include "job/layers.h"
#include "job/prepared_scene.h"
#include "load/load_scene.h"
#include "scene/scene.h"

namespace orrery::job {

/// A job whose scene is loaded, compiled and checked: what is known before the first sample.
struct PreparedJob {
  const Job& job;
  std::shared_ptr<PreparedScene> prepared;
  Layers layers;                 ///< that the job computes
  image::Provenance provenance;  ///< what the sums depend on
  std::string stamp;             ///< what the images depend on
  annotation::Drawing drawing;   ///< over the image, without outlines

  const load::LoadedScene& loaded() const { return prepared->loaded(); }
  const scene::Scene& scene() const { return loaded().read.scene; }
  const compile::CompiledScene& compiled() const { return prepared->compiled(); }
};

/// Throws the error of a stopped job.
///
/// `remedy`   what can be done, after "; "
[[noreturn]] void stop_job(const std::string& remedy = {});

/// Loads and compiles the scene of a job, and checks everything that can be known before rendering.
///
/// `files`    receives the files that the scene names
/// `report`   receives what is known so far, also if the job fails; `was_skipped` if its files are up to date, in which
///            case the checks of memory and disk are left out
/// `watch`    measures the phases
/// Domain     `job` outlives the result
/// Errors     base::Error of any kind; kStopped if the job was cancelled
PreparedJob prepare_job(const Job& job, base::FileSet& files, JobReport& report, base::Stopwatch& watch);

}  // namespace orrery::job
