#include <CLI/CLI.hpp>
#include <memory>

#include "app/command/calibrate.hpp"
#include "app/command/command_groups.hpp"

namespace tandem::app {
namespace {

constexpr const char* kFrames = "camera:/dev/video0, film:FILE, folder:FOLDER of .png or .pgm, or pipe:FILE";

}  // namespace

void add_calibrate_commands(CLI::App& app, int& code) {
  const auto options = std::make_shared<CalibrateOptions>();
  CalibrateOptions& o = *options;
  CLI::App* c = app.add_subcommand("calibrate", "Find a camera's lens and place, for the tracker 'apriltag'.");
  c->require_subcommand(1);

  CLI::App* b = c->add_subcommand("board", "Make a board to print (A4): FILE.svg, .pdf or .png, and FILE.json.");
  b->add_option("-o,--out", o.out, "The page: .pdf, .svg or .png")->required();
  b->add_option("--columns", o.columns, "Tags in a line")->capture_default_str()->check(CLI::Range(2, 100));
  b->add_option("--rows", o.rows, "Lines")->capture_default_str()->check(CLI::Range(2, 100));
  b->add_option("--size", o.size, "Side of a tag's black square")->capture_default_str();
  b->add_option("--gap", o.gap, "White between two tags")->capture_default_str();
  b->add_option("--family", o.family, "Of tags")->capture_default_str();
  b->add_option("--first", o.first, "Number of the first tag")->capture_default_str()->check(CLI::Range(0, 100000));
  b->callback([options, &code] { code = calibrate_board(*options); });

  CLI::App* l = c->add_subcommand("camera", "Find focal lengths, centre and distortion from frames of the board.");
  l->footer(
      "Show the board in 15 to 30 ways: tilted by 20 to 45 degrees to all sides, near and far, in all corners of the "
      "picture, held still and in focus. Focus and zoom must stay as they are from then on.");
  l->add_option("--board", o.board, "The file that `tandem calibrate board` wrote beside the page")->required();
  l->add_option("--frames", o.frames, kFrames)->required();
  l->add_option("-o,--out", o.out, "The camera's file")->required();
  l->add_option("--every", o.every, "Only every so manyth frame: of films")->check(CLI::Range(1, 100000));
  l->add_option("--most", o.most, "Views that are enough")->capture_default_str()->check(CLI::Range(6, 200));
  l->add_flag("--wide", o.wide, "A third coefficient of distortion, for lenses of more than 90 degrees");
  l->callback([options, &code] { code = calibrate_camera(*options); });

  CLI::App* a = c->add_subcommand("arena", "Find where the camera hangs, from tags at known places.");
  a->add_option("--camera", o.camera, "The camera's file, which gets its place")->required();
  a->add_option("--frames", o.frames, kFrames)->required();
  a->add_option("--tag", o.tags,
                "A tag that lies at X,Y (of its centre, in metres), at a height Z, its upper edge pointing to DEGREES: "
                "ID=X,Y[,Z[,DEGREES]]; repeatable, four at least")
      ->allow_extra_args(false);
  a->add_option("--size", o.size, "Side of these tags' black square, for those with DEGREES")->capture_default_str();
  a->add_option("--family", o.family, "Of tags")->capture_default_str();
  auto* board = a->add_option("--board", o.board, "The board's file, where it is the board that lies there");
  a->add_option("--at", o.at, "Where its centre lies, where its upper edge points to, its thickness: X,Y,DEGREES[,Z]")
      ->needs(board);
  a->add_option("-o,--out", o.out, "Another file to write");
  a->callback([options, &code] { code = calibrate_arena(*options); });
}

}  // namespace tandem::app
