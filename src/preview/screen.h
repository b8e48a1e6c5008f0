// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>

#include "preview/terminal_kind.h"
#include "preview/tty.h"

namespace orrery::preview {

/// The bottom of a terminal: an image, and a progress bar below it. Messages scroll above the image.
///
/// bar() and note() only copy the text; poll() writes it on the preview's thread, without waiting for the terminal.
class Screen {
 public:
  /// Queries the terminal for its graphics capabilities.
  ///
  /// Errors     base::Error(kUsage) if the descriptor is not a terminal, or one without colours
  explicit Screen(int descriptor, const Environment& environment = preview::environment);

  Graphics graphics() const { return graphics_; }

  /// Sets the progress bar, one line without newline. Thread-safe.
  void bar(const std::string& text);

  /// Adds a message of whole lines. Thread-safe.
  void note(const std::string& text);

  /// The size of the terminal and of a cell, px.
  struct CellGrid {
    int columns = 0, rows = 0;
    int cell_width = 1, cell_height = 2;  ///< in text mode, the pixels that a cell shows

    bool operator==(const CellGrid&) const = default;
  };
  CellGrid cell_grid() const;

  /// Sets the image: the bytes that draw it, and the number of rows that it covers.
  void show(std::string drawing, int rows);

  /// True if all output has been written, so that another image can be shown.
  bool is_idle() const { return sent_ == output_.size(); }

  /// Writes pending changes, as much as the terminal accepts.
  void poll();

  /// Removes the bar, and writes the rest unless the terminal hangs. Afterwards, note() writes to stderr.
  void finish();

 private:
  void compose();
  void send();

  Tty tty_;
  TerminalReply reply_;
  Graphics graphics_;
  std::string drawing_;
  int rows_ = 0;             ///< rows of the image
  bool is_drawn_ = true;     ///< the image is on the terminal
  int shown_rows_ = 0;       ///< rows of the terminal above the cursor that belong to the image
  TerminalSize shown_size_;  ///< size of the terminal when the image was drawn
  std::string output_;       ///< output that is being written
  std::size_t sent_ = 0;     ///< number of bytes of output_ that have been written
  std::mutex mutex_;         // guards the members below
  std::string bar_, notes_;
  bool bar_changed_ = false;
  bool is_finished_ = false;
};

}  // namespace orrery::preview
