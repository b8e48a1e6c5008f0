// SPDX-License-Identifier: Apache-2.0
#include "job/prepared_scene.h"

#include <utility>

#include "annotation/annotate.h"
#include "base/available_memory.h"
#include "compile/camera_basis.h"
#include "compile/compile.h"
#include "job/resources.h"
#include "job/scene_hash.h"
#include "kernel/isa.h"
#include "load/load_scene.h"
#include "render/render.h"

namespace orrery::job {
namespace {

/// What has moved in the frames before and after.
film::NeighborFrames neighbors_of(const load::ReadResult& read) {
  film::NeighborFrames out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!read.neighbors[i]) continue;
    const scene::Scene& other = *read.neighbors[i];
    const double frames = i == 0 ? -1 : 1;
    out[i] = std::make_shared<const film::NeighborFrame>(film::NeighborFrame{
        compile::compile_camera(other.camera, read.scene.image, compile::view_scale(other.camera)),
        compile::sphere_motion(read.scene, other, frames), compile::rod_motion(read.scene, other, frames)});
  }
  return out;
}

}  // namespace

PreparedScene::PreparedScene(bool keeps_files) {
  if (keeps_files) open_data_ = points::open_once();
}

void PreparedScene::clear() {
  accel_.reset();  // refers to the compiled spheres
  loaded_.reset();
  compiled_ = {};
  is_complete_ = false;
}

const load::LoadedScene& PreparedScene::load(load::SceneRequest request) {
  if (!std::exchange(is_complete_, false)) clear();
  request.keeps_authored = true;
  if (!request.source.open_data) request.source.open_data = open_data_;
  request.on_change = [this](const scene::Parts& changed) {
    if (changed.geometry) {
      accel_.reset();
      compiled_ = {};
    }
    if (changed.look) compiled_.environment = nullptr;
  };
  loaded_ = load::load_scene(request, std::exchange(loaded_, {}));
  static_cast<void>(annotation::title_of(loaded_->read.scene, request.source.frame));  // errors are found early
  return *loaded_;
}

const compile::CompiledScene& PreparedScene::compile(std::uint64_t memory_limit) {
  load::ReadResult& read = loaded_->read;
  const scene::Parts& changed = loaded_->changed;
  if (changed.geometry) {
    accel_.reset();
    compiled_ = {};
    require_memory_to_compile(read.scene, memory_limit);
  }
  neighbors_ = neighbors_of(read);
  compile::update_and_release(read.scene, read.closing ? &*read.closing : nullptr, changed, compiled_);
  if (changed.geometry || changed.assignment) {
    sphere_hash_ = hash_of_spheres(compiled_);
    // Keep no second copy of the spheres during the BVH build.
    for (scene::Points& points : read.scene.points) points.release_spheres();
    for (scene::RodFile& rods : read.scene.rod_files) rods.release_rods();
    base::release_freed_memory();
  }
  hashes_ = scene_hashes(compiled_, sphere_hash_);
  is_complete_ = true;
  return compiled_;
}

accel::Accel& PreparedScene::accelerator(int threads, const accel::BuildMonitor& monitor) {
  if (accel_ && isa_ != kernel::isa_name()) accel_.reset();
  isa_ = kernel::isa_name();
  if (accel_)
    accel_->set_opacity(compiled_.view().opacity);
  else
    accel_ = render::build(compiled_, threads, monitor);
  return *accel_;
}

}  // namespace orrery::job
