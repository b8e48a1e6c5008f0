// SPDX-License-Identifier: Apache-2.0
#include "accel/list.h"

#include <memory>
#include <optional>

#include "accel/accel.h"

namespace orrery::accel {
namespace {

class List final : public Accel {
 public:
  List(const kernel::SceneView& view, kernel::Precision precision)
      : scene_{view, {view.duplicates.begin(), view.duplicates.end()}}, precision_(precision) {}

  kernel::Tracer tracer(std::optional<Traversal>) const noexcept override {
    kernel::Tracer t = list_tracer(precision_);
    t.self = &scene_;
    return t;
  }
  void set_opacity(const float* opacity) noexcept override { scene_.view.opacity = opacity; }
  std::string name() const override { return "list"; }
  std::size_t bytes() const noexcept override { return scene_.duplicates.size() * sizeof(scene_.duplicates[0]); }

 private:
  DistinctObjects scene_;
  kernel::Precision precision_;
};

}  // namespace

std::unique_ptr<Accel> make_list(const kernel::SceneView& scene, kernel::Precision precision) {
  return std::make_unique<List>(scene, precision);
}

}  // namespace orrery::accel
