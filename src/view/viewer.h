// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "annotation/legend.h"
#include "base/error.h"
#include "base/read_progress.h"
#include "data/table.h"
#include "job/job.h"
#include "job/prepared_scene.h"
#include "job/rendering.h"
#include "math/vec3.h"
#include "preview/canvas.h"
#include "scene/scene.h"
#include "view/picker.h"
#include "view/wish.h"

namespace orrery::view {

/// What the words of a command line show.
struct Subject {
  job::Job job;                                    ///< scene and sampling; no outputs
  std::vector<std::string> notes = {};             ///< choices and warnings, a line each
  std::optional<data::FrameInfo> data = {};        ///< what the frame of a data file contains
  std::map<std::string, std::string> chosen = {};  ///< values of controls that the data decided, by option
  std::optional<int> frame_count = 1;              ///< frames of a data file; empty: unknown
  std::vector<int> frames = {};                    ///< to render, of a film
  annotation::LegendColors legend = {};            ///< as a display shows them
  std::optional<math::Vec3d> up = {};              ///< what drags keep upright; empty: that of the scene's camera
};

/// A control of the page that stays out of the command: it becomes the --range of all frames.
inline constexpr const char* kAllFrames = "--frames";

/// An error with its diagnostics, as the command line reports it.
std::string text_of(const base::Error& error);

/// Makes the subject of a command line.
///
/// `words`    options and their values
/// Errors     base::Error: what the command reports; kStopped in a base::StopScope
using MakeSubject = std::function<Subject(const std::vector<std::string>& words)>;

/// An image for clients.
struct Frame {
  std::uint64_t number = 0;  ///< 0: none yet
  std::uint64_t wish = 0;    ///< number of the wish that it grants
  std::string client = {};   ///< of that wish
  std::shared_ptr<const std::string> bytes = nullptr;
  std::string type = {};             ///< "image/jpeg"; "image/png" if it is finished
  double samples = 0;                ///< mean over the pixels; 0: a sketch
  std::optional<double> noise = {};  ///< of a finished image with a target noise
  bool is_finished = false;
};

/// What the page shows besides the image.
struct State {
  std::uint64_t number = 0;  ///< changes with every other member
  Wish wish;
  std::uint64_t asked = 1;                                                     ///< number of the wish
  std::shared_ptr<const Subject> subject = std::make_shared<const Subject>();  ///< of the last wish that was read
  std::vector<std::string> words;                    ///< of the command that makes this picture, without outputs
  std::optional<scene::Camera> camera;               ///< of the scene that is shown
  std::optional<std::array<math::Vec3d, 2>> bounds;  ///< of the scene that is shown: see Picker
  int width = 0, height = 0;                         ///< of the finished image
  std::uint64_t read = 0;                            ///< number of the last wish whose options `subject` has
  std::uint64_t served = 0;           ///< number of the last wish that was granted, or refused as `problem` says
  std::string activity;               ///< "reading" or a phase of job::Hooks; empty: rendering or finished
  double progress = 0;                ///< of the activity, 0 to 1; 0: unknown; 1: what follows a read is under way
  std::string problem;                ///< why the last wish was not granted
  std::vector<std::string> warnings;  ///< about the image that is shown
};

/// Renders what clients want to see, on one thread, with one prepared scene.
///
/// The first image of a wish is a sketch: without lighting, one sample per pixel, as large as can be rendered in 45 ms.
/// A wish that does not move is then rendered completely; meanwhile, frame() returns what is rendered so far, once all
/// pixels have samples. The page draws it over the sketch.
class Viewer {
 public:
  /// `fixed`    words of the command line that no control sets
  Viewer(MakeSubject make, std::vector<std::string> fixed, Wish first);
  /// Stops rendering.
  ~Viewer();

  /// Returns the number of the wish.
  std::uint64_t ask(Wish wish);
  /// Stops what is done for the last wish, unless a scene is prepared, which would be lost.
  void cancel();

  /// The first frame with a larger number. Waits for it, but not longer than `patience`, nor when the state has another
  /// number than `state`; then the number of the frame is not larger.
  Frame frame(std::uint64_t after, std::chrono::milliseconds patience, std::optional<std::uint64_t> state = {});

  /// The words of the command that grants a wish.
  std::vector<std::string> words(const Wish& wish) const { return words_of(fixed_, wish); }

  /// See Picker.
  bool can_pick() const { return picker_.is_open(); }
  std::optional<Picked> pick(double x, double y) { return picker_.pick(x, y); }
  State state() const;

  /// The finished image; null while it is rendered.
  std::shared_ptr<const job::Rendering> finished() const;

  /// Lets all calls of frame() return.
  void stop();

 private:
  struct Live;
  struct Image;

  void run();
  void make_subject(Wish& wish, std::uint64_t number);
  void correct(const Wish& wish, std::uint64_t number);
  void render(const Wish& wish, std::uint64_t number, bool is_sketch);
  job::Hooks hooks_for(Image& image);
  void begin(Image& image, const display::PictureInfo& info, const annotation::Drawing& drawing);
  void finish(Image& image);
  void announce();
  void set_activity(const std::string& activity, double progress = 0);
  void set_read(std::uint64_t wish);
  void set_served(std::uint64_t wish, const std::string& problem);
  void drop_live();
  void refresh(Live& live);
  void publish(Frame frame);

  const MakeSubject make_;
  const std::vector<std::string> fixed_;

  mutable std::mutex mutex_;  // guards what follows
  mutable std::condition_variable changed_;
  State state_;
  Frame frame_;
  std::uint64_t served_ = 0;  ///< number of the last wish that was taken up
  bool moves_ = false;        ///< the wish that is rendered moves
  /// The rendering thread does what may be interrupted. Otherwise it prepares the scene, which would be lost.
  bool is_cancellable_ = false;
  bool stops_ = false;
  std::shared_ptr<Live> live_;  ///< the image that is rendered; null: none, or a moving one
  std::shared_ptr<const job::Rendering> finished_;

  std::atomic<bool> cancel_{false};
  const std::shared_ptr<base::ReadProgress> reading_ = std::make_shared<base::ReadProgress>(0);
  // Of the rendering thread.
  bool is_new_subject_ = false;                          ///< it has not been rendered yet
  std::optional<decltype(Wish::options)> made_options_;  ///< of the subject
  const char* other_size_ = "";                          ///< a setting that fits another camera than the subject's
  scene::Shading shading_ = {};                          ///< of the subject
  std::shared_ptr<job::PreparedScene> prepared_;
  Picker picker_;
  double pixels_per_second_ = 4e6;                                            ///< of sketches
  std::optional<std::pair<std::vector<std::string>, std::string>> sketched_;  ///< words and client of the last one
  std::thread thread_;
};

}  // namespace orrery::view
