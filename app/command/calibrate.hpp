// The commands `tandem calibrate …`: the board, a camera's lens, where it hangs.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace tandem::app {

struct CalibrateOptions {
  std::string out;            ///< what is made
  std::string board, frames;  ///< files of a board; where frames come from
  std::string camera;         ///< of `arena`: the file with the lens
  std::string family = "tag36h11";
  std::int64_t columns = 6, rows = 4, first = 0;
  std::string size = "30 mm", gap = "10 mm";
  std::int64_t every = 1, most = 40;
  bool wide = false;
  std::vector<std::string> tags;  ///< of `arena`: ID=X,Y[,Z[,DEGREES]]
  std::string at;                 ///< of `arena`: where the board lies: X,Y,DEGREES[,Z]
};

int calibrate_board(const CalibrateOptions& options);
int calibrate_camera(const CalibrateOptions& options);
int calibrate_arena(const CalibrateOptions& options);

}  // namespace tandem::app
