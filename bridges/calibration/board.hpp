// The printed board that cameras are calibrated with: AprilTags in lines and columns.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "hal/result.hpp"
#include "hal/vector2.hpp"

namespace tandem::bridges::calibration {

/// The origin is the centre of the board, x along its lines, y up along its columns.
struct Board {
  std::string family = "tag36h11";
  std::size_t columns = 6, rows = 4;
  double size_m = 0.03;   ///< side of a tag's black square
  double gap_m = 0.01;    ///< between two of them
  std::size_t first = 0;  ///< number of the tag at the upper left; the others follow line by line

  double width_m() const noexcept;  ///< from the first black square's edge to the last one's
  double height_m() const noexcept;
  /// Corners as apriltag::Detection has them, on the board. Nothing: the tag is not on it.
  std::optional<std::array<hal::Vector2, 4>> corners_m(std::size_t tag) const noexcept;
};

/// Errors: fewer than two lines or columns, tags that the family does not have, sizes that make no sense, more than
/// the paper (A4, lying) holds.
hal::Status check_board(const Board& board);

/// A page to print, with lines by which to see whether the printer kept the size. The board is sound.
hal::Result<std::string> board_svg(const Board& board);

hal::Result<Board> read_board(const std::string& path);
hal::Status write_board(const std::string& path, const Board& board);

}  // namespace tandem::bridges::calibration
