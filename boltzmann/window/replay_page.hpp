// Replay page: a stored run as one HTML text, the page of the window with its frames in it. It plays in any browser or
// notebook, without a port and without this program (protocol.md, "A page without a window").
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace boltzmann {

class Replay;

struct ReplayPageOptions {
  /// Names of what is shown, 8 at most; empty: the views and pictures of the run, or the first that there is. The table
  /// of measured quantities is always there, with its curves.
  std::vector<std::string> views = {};
  std::size_t frames = 100;  ///< at most; evenly chosen, the first and the last among them
  /// Size of the text at most, in 10^6 bytes. Where frames are larger than that allows, fewer particles are shown (one
  /// of every n, down to some thousand), then fewer frames; the page's status line says so.
  double megabytes = 8;
};

struct ReplayPage {
  std::string html;
  std::size_t frames = 0, stored_frames = 0;  ///< in the page, and in the trajectory
  std::string message =
      {};  ///< what the page says of frames, particles and rows that were left out; empty: nothing was
};

/// The page of a replay, which stands at the last chosen frame then. Error (one line) for a view that there isn't or
/// that can't be drawn of frames, no frames, and a size in which no frame has room.
ReplayPage replay_page(Replay& replay, ReplayPageOptions const& options = {});

/// The page of the run in a folder. Error as above, and if the folder holds no run or no trajectory.
ReplayPage replay_page(std::string const& folder, ReplayPageOptions const& options = {});

}  // namespace boltzmann
