// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"
#include "display/config.h"
#include "display/config_files.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;

/// Collects the files of transforms.
class TableFinder {
 public:
  explicit TableFinder(const ocio::Config& config) : context_(config.getCurrentContext()) {}

  void add(const ocio::ConstTransformRcPtr& transform) {
    if (const auto group = ocio::DynamicPtrCast<const ocio::GroupTransform>(transform)) {
      for (int i = 0; i < group->getNumTransforms(); ++i) add(group->getTransform(i));
    } else if (const auto file = ocio::DynamicPtrCast<const ocio::FileTransform>(transform)) {
      try {
        found_.emplace_back(context_->resolveFileLocation(file->getSrc()));
      } catch (const ocio::Exception&) {  // a missing file, which matters only to a view that uses it
      }
    }
  }

  std::vector<std::filesystem::path> take() { return std::move(found_); }

 private:
  ocio::ConstContextRcPtr context_;
  std::vector<std::filesystem::path> found_;
};

}  // namespace

std::vector<std::filesystem::path> table_files(const std::filesystem::path& config_file) {
  Config loaded;
  try {
    loaded = load_config(config_file.string());
  } catch (const base::Error&) {
    return {};
  }
  const ocio::Config& config = *loaded.config;
  TableFinder tables(config);
  for (int i = 0; i < config.getNumColorSpaces(ocio::SEARCH_REFERENCE_SPACE_ALL, ocio::COLORSPACE_ALL); ++i) {
    const ocio::ConstColorSpaceRcPtr space = config.getColorSpace(
        config.getColorSpaceNameByIndex(ocio::SEARCH_REFERENCE_SPACE_ALL, ocio::COLORSPACE_ALL, i));
    for (const auto direction : {ocio::COLORSPACE_DIR_TO_REFERENCE, ocio::COLORSPACE_DIR_FROM_REFERENCE})
      tables.add(space->getTransform(direction));
  }
  for (int i = 0; i < config.getNumViewTransforms(); ++i) {
    const ocio::ConstViewTransformRcPtr view = config.getViewTransform(config.getViewTransformNameByIndex(i));
    for (const auto direction : {ocio::VIEWTRANSFORM_DIR_TO_REFERENCE, ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE})
      tables.add(view->getTransform(direction));
  }
  for (int i = 0; i < config.getNumLooks(); ++i) {
    const ocio::ConstLookRcPtr look = config.getLook(config.getLookNameByIndex(i));
    tables.add(look->getTransform());
    tables.add(look->getInverseTransform());
  }
  for (int i = 0; i < config.getNumNamedTransforms(ocio::NAMEDTRANSFORM_ALL); ++i) {
    const ocio::ConstNamedTransformRcPtr named =
        config.getNamedTransform(config.getNamedTransformNameByIndex(ocio::NAMEDTRANSFORM_ALL, i));
    for (const auto direction : {ocio::TRANSFORM_DIR_FORWARD, ocio::TRANSFORM_DIR_INVERSE})
      tables.add(named->getTransform(direction));
  }
  return tables.take();
}

}  // namespace orrery::display
