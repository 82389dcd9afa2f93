// Replay page: a stored run as a single HTML text, the page of the window with embedded frames. It plays in any browser
// or notebook, without a port and without this program (protocol.md, "A page without a window").
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace boltzmann {

class Replay;

struct ReplayPageOptions {
  /// Names of the views, at most 8. Empty: the views and pictures of the run, or the first available view. The table of
  /// measured quantities is always included, with its curves.
  std::vector<std::string> views = {};
  std::size_t frames = 100;  ///< maximum; evenly spaced, including the first and the last
  /// Maximum size of the text, in 10^6 bytes. If frames are too large, fewer particles are included (one of every n,
  /// down to some thousand), then fewer frames. The page's status line reports this.
  double megabytes = 8;
};

struct ReplayPage {
  std::string html;
  std::size_t frames = 0, stored_frames = 0;  ///< in the page, and in the trajectory
  std::string message = {};                   ///< the page's note on omitted frames, particles and rows; empty: none
};

/// The page of a replay, which is then at the last selected frame. Throws Error (one line) for an unknown view or one
/// that can't be drawn from frames, no frames, or a size too small for a single frame.
ReplayPage replay_page(Replay& replay, ReplayPageOptions const& options = {});

/// The page of the run in a folder. Throws Error as above, and if the folder holds no run or no trajectory.
ReplayPage replay_page(std::string const& folder, ReplayPageOptions const& options = {});

}  // namespace boltzmann
