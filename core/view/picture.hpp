// A picture of a space from above, as SVG, PNG or PDF: for servers without a display, reports and papers.
#pragma once
#include <string>
#include <vector>

#include "core/space/space.hpp"
#include "core/view/drawing.hpp"
#include "core/view/render.hpp"
#include "core/view/trails.hpp"
#include "hal/output_file.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

struct PictureOptions {
  /// What is wrong with a robot that stands for a real one, e.g. "link lost".
  struct Trouble {
    RobotId robot;
    std::string state;
  };

  std::string experiment;  ///< its name, for the title
  std::uint64_t seed = 0;
  hal::TimeNs time_ns = 0;            ///< of the run
  std::vector<Trouble> trouble = {};  ///< real robots that are not named are well
  PictureLook look = {};
  const Trails* trails = nullptr;  ///< null: none
  std::int64_t ticks_done = 0;     ///< for the trails
};

/// Draws `space`. Refers to `space` for the floor: draw it before that changes.
Drawing drawing_of(const Space& space, const PictureOptions& options);

/// By the ending of `path`: .svg, .png or .pdf. Error: another one; names those that there are.
hal::Result<PictureFormat> picture_format(const std::string& path);

/// Writes the drawing to `file` in the format of its ending, and commits it. Error: as below.
hal::Status write_picture(const Drawing& drawing, hal::OutputFile& file, const PictureLook& look);

/// Writes `space` to `file` in the format of its ending, and commits it. Error: the file cannot be written or rendered.
hal::Status write_picture(const Space& space, hal::OutputFile& file, const PictureOptions& options);

}  // namespace tandem::core
