// Finds a camera's lens from views of a board.
#pragma once
#include <string>
#include <vector>

#include "bridges/apriltag/detector.hpp"
#include "bridges/calibration/board.hpp"
#include "bridges/camera/camera.hpp"

namespace tandem::bridges::calibration {

/// What one frame shows of the board.
struct View {
  std::string name;  ///< of the frame, for messages
  std::vector<apriltag::Detection> tags;
};

inline constexpr std::size_t kFewestViews = 6;
inline constexpr std::size_t kFewestTags = 6;  ///< of a view

/// Whether a view shows enough of the board to be of use.
bool is_of_use(const View& view, const Board& board) noexcept;
/// Whether the board has hardly moved, by pixels, between two views.
bool are_alike(const View& a, const View& b, const Board& board) noexcept;

struct LensFit {
  camera::Lens lens;
  double rms_px = 0.0;
  double sd_focal_px = 0.0, sd_centre_px = 0.0;
  std::size_t views = 0;              ///< that were used
  std::vector<std::string> left_out;  ///< views that do not fit the others
  double covered = 0.0;               ///< part of the picture's fields (8 by 6) in which a corner was seen
  double most_tilt_rad = 0.0;         ///< between two views of the board
};

/// `wide`: the third radial coefficient, too. Errors: too few views, all alike or all parallel, only a part of the
/// picture covered, frames that do not fit the board; each says what to do.
hal::Result<LensFit> fit_lens(const std::vector<View>& views, const Board& board, std::size_t width, std::size_t height,
                              bool wide);

}  // namespace tandem::bridges::calibration
