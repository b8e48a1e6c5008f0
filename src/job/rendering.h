// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "annotation/drawing.h"
#include "base/file_set.h"
#include "display/settings.h"
#include "film/picture.h"
#include "image/header.h"
#include "job/job.h"

namespace orrery::job {

/// A rendered image in memory, and the other data that are needed to write its files.
struct Rendering {
  Job job;                ///< the request, without hooks and data in memory
  film::Picture picture;  ///< R, G, B, A, then the layers of the scene
  image::Header header, reproducible_header;
  annotation::Drawing drawing;   ///< over the image
  display::Settings display;     ///< from the request and the scene
  image::Provenance provenance;  ///< everything that the image depends on
  JobReport report;
  base::FileSet files;  ///< input files of the job
};

/// Writes the same files of a rendering that a job with these outputs would write, except that the stamps of display
/// formats differ if the scene has layers, which such a job does not compute.
///
/// `outputs`  images and how to write them; empty names of the display transform are those of the rendering
/// Domain     no deep image and no statistics
/// Result     values changed to fit the files
/// Errors     base::Error: kUsage, kCannotCreate before any file is written; kIo
image::WriteReport write_rendering(const Rendering& rendering, const Outputs& outputs);

/// Resolves the display transform of a rendering.
///
/// `display`  empty names are those of the rendering
/// Errors     those of display::choose()
display::Settings display_of(const Rendering& rendering, display::Settings display);

}  // namespace orrery::job
