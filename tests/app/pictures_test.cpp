// Pictures and films as a user asks for them.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <gtest/gtest.h>

#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::eventually;
using scenarios::Folder;
using scenarios::json_value;
using scenarios::Tandem;
using scenarios::text_of;

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";
const std::string kExperiment = kConfigs + "epuck_diffusion.xml";

/// What was printed; errors where the exit code is another than 0.
std::string output_of(const Folder& folder, const std::vector<std::string>& arguments, int code = 0) {
  Tandem tandem(arguments, folder.path());
  EXPECT_EQ(tandem.wait(), code) << tandem.errors();
  return code == 0 ? tandem.output() : tandem.errors();
}

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null").c_str()) == 0;  // NOLINT(concurrency-mt-unsafe)
}

std::string answer_of(const std::string& command) {
  FILE* const pipe = popen(command.c_str(), "r");
  std::string text;
  std::array<char, 256> part{};
  while (fgets(part.data(), part.size(), pipe) != nullptr) text += part.data();
  pclose(pipe);
  return text;
}

TEST(Pictures, AreDrawnAfterTheTicksThatAreAskedFor) {
  Folder folder;
  output_of(folder, {"run", kExperiment, "--seconds", "2", "--picture", "end.svg", "--picture-at", "0,10,20",
                     "--picture-ids", "--picture-axes", "--picture-trails", "1", "--quiet"});
  const std::string first = text_of(folder.path() / "end-000000.svg");
  EXPECT_NE(first.find("t = 0 s"), std::string::npos);
  EXPECT_NE(first.find(">ep7<"), std::string::npos);
  EXPECT_EQ(first.find("<polyline"), std::string::npos);
  const std::string middle = text_of(folder.path() / "end-000010.svg");
  EXPECT_NE(middle.find("t = 1 s"), std::string::npos);
  EXPECT_NE(middle.find("<polyline"), std::string::npos);
  EXPECT_EQ(text_of(folder.path() / "end-000020.svg"), text_of(folder.path() / "end.svg"));
}

TEST(Pictures, AndFilmsChangeNoBitOfTheRun) {
  Folder folder;
  for (const char* file : {"epuck_diffusion.xml", "footbot_gripping.xml"}) {
    const auto hash = [&](std::vector<std::string> more) {
      std::vector<std::string> arguments = {"run", kConfigs + file, "--seconds", "2", "--threads",
                                            "2",   "--report",      "-"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      return json_value(output_of(folder, arguments), "state_hash");
    };
    EXPECT_EQ(hash({}), hash({"--film", "frames/", "--film-every", "5", "--picture", "p.svg", "--picture-at", "3,7",
                              "--picture-trails", "1", "--picture-layers", "proximity,trails,range_and_bearing,cameras",
                              "--picture-size", "200"}));
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "frames/000004.png"));
}

TEST(Pictures, ShowTheLayersThatAreAskedFor) {
  Folder folder;
  const auto lines = [&](const std::vector<std::string>& more) {
    std::vector<std::string> run = {"run", kExperiment, "--seconds", "2", "--quiet", "--picture", "p.svg"};
    run.insert(run.end(), more.begin(), more.end());
    output_of(folder, run);
    const std::string svg = text_of(folder.path() / "p.svg");
    std::size_t n = 0;
    for (std::size_t at = svg.find("<polyline"); at != std::string::npos; at = svg.find("<polyline", at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(lines({}), 0U);
  EXPECT_EQ(lines({"--picture-layers", "proximity"}), 50U * 8U) << "a ray a sensor";
  EXPECT_EQ(lines({"--picture-layers", "trails,proximity"}), 50U * 9U);
  const auto fails = [&](const std::vector<std::string>& more, const char* part) {
    std::vector<std::string> run = {"run", kExperiment, "--seconds", "1"};
    run.insert(run.end(), more.begin(), more.end());
    const std::string errors = output_of(folder, run, 1);
    EXPECT_NE(errors.find(part), std::string::npos) << errors;
  };
  fails({"--picture", "p.svg", "--picture-layers", "proximty"}, "Did you mean 'proximity'?");
  fails({"--picture", "p.svg", "--picture-layers", "measures"}, "has a panel alone");
  fails({"--picture-layers", "proximity"}, "needs --picture or --film");
}

TEST(Pictures, OfARecordAreThoseOfTheRun) {
  Folder folder;
  for (const char* file : {"epuck_diffusion.xml", "footbot_synchronization.xml", "footbot_safety.xml"}) {
    const std::vector<std::string> look = {"--picture-ids",    "--picture-axes",        "--picture-trails", "1",
                                           "--picture-layers", "proximity,light,trails"};
    std::vector<std::string> run = {"run",       kConfigs + file, "--seconds",     "3",  "--quiet",
                                    "--picture", "end.svg",       "--picture-at",  "17", "--record",
                                    "r",         "--set",         "record.ports=*"};
    run.insert(run.end(), look.begin(), look.end());
    const bool areas = std::string_view(file) == "footbot_safety.xml";
    if (areas) run.insert(run.end(), {"--without", "fb0", "--without", "fb1", "--set", "framework.time.mode=fast"});
    output_of(folder, run);
    std::vector<std::string> draw = {"picture", "r", "--at", "17", "-o", "again.svg"};
    draw.insert(draw.end(), look.begin(), look.end());
    output_of(folder, draw);
    // Robots may come in another order, and lie in another millionth of a metre.
    const auto parts = [&](const char* name, const char* part) {
      const std::string svg = text_of(folder.path() / name);
      std::size_t n = 0;
      for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1)) ++n;
      return n;
    };
    for (const char* part : {"<use ", "class=\"led\"", "<polyline", "<text", "<rect", "t = 1.7 s", "class=\"turret\"",
                             "<polygon", "dock: 0.05 m/s"})
      EXPECT_EQ(parts("again.svg", part), parts("end-000017.svg", part)) << part << " of " << file;
    EXPECT_EQ(parts("again.svg", "<polygon"), areas ? 3U : 0U);
    EXPECT_GT(parts("again.svg", "<polyline"), areas ? 0U : 40U) << "layers, too";
    output_of(folder, {"picture", "r", "--at", "17", "--povray", "scene.pov"});
    EXPECT_EQ(parts("scene.pov", "dock: 0.05 m/s"), areas ? 1U : 0U);
    EXPECT_EQ(parts("scene.pov", "transmit 0.8"), areas ? 2U : 0U) << "the keep-out and the zone are tinted";
    EXPECT_EQ(parts("scene.pov", "no_shadow"), areas ? 5U : 0U) << "three edges";
    EXPECT_GT(parts("again.svg", "<use "), areas ? 1U : 20U);
  }
}

TEST(Films, AreMadeOfRecordsToo) {
  Folder folder;
  output_of(folder, {"run", kExperiment, "--seconds", "4", "--quiet", "--record", "r"});
  output_of(folder, {"film", "r", "-o", "all/", "--film-every", "10", "--picture-size", "100"});
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "all/000004.png"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "all/000005.png"));
  output_of(folder, {"run", kExperiment, "--seconds", "4", "--quiet", "--record", "r", "--set", "record.every=10"});
  output_of(folder, {"film", "r", "-o", "some/", "--picture-size", "100"});
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "some/000003.png"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "some/000005.png"));

  const auto fails = [&](const std::vector<std::string>& arguments, int code, const char* part) {
    const std::string errors = output_of(folder, arguments, code);
    EXPECT_NE(errors.find(part), std::string::npos) << errors;
  };
  fails({"picture", "r", "--at", "15", "-o", "p.svg"}, 1, "near that it has 11 and 21");
  fails({"picture", "r", "--at", "400", "-o", "p.svg"}, 1, "near that it has 31");
  fails({"picture", "nowhere", "-o", "p.svg"}, 1, "there is no such file");
  fails({"picture", kExperiment, "-o", "p.svg"}, 1, "is no record");
  fails({"picture", "r"}, 2, "--picture");
  fails({"picture", "r", "-o", "r"}, 1, ".svg");
  fails({"film", "r"}, 2, "--film");
  fails({"film", "nowhere", "-o", "a/"}, 1, "there is no such file");
}

TEST(Films, HaveAFrameForEveryTickThatWasAskedFor) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  Folder folder;
  output_of(folder, {"run", kExperiment, "--seconds", "3", "--film", "film.mp4", "--film-every", "2", "--film-rate",
                     "20", "--picture-size", "201", "--quiet"});
  const std::string said =
      answer_of("ffprobe -v error -count_frames -show_entries stream=codec_name,nb_read_frames,r_frame_rate -of csv '" +
                (folder.path() / "film.mp4").string() + "'");
  EXPECT_EQ(said, "stream,h264,20/1,16\n");
}

TEST(Films, ThatFailEndARunWithItsOtherOutputsWhole) {
  Folder folder;
  std::filesystem::create_directory(folder.path() / "bin");
  const auto ffmpeg = folder.write("bin/ffmpeg", "#!/bin/sh\nhead -c 1000 > /dev/null\necho disk full >&2\nexit 1\n");
  std::filesystem::permissions(ffmpeg, std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
  setenv("PATH", ((folder.path() / "bin").string() + ":" + path).c_str(), 1);
  const std::string errors =
      output_of(folder, {"run", kExperiment, "--seconds", "5", "--film", "film.mp4", "--report", "r.json"}, 3);
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(errors.find("ffmpeg gave up: disk full; it goes on without the film"), std::string::npos) << errors;
  EXPECT_EQ(json_value(text_of(folder.path() / "r.json"), "finished"), "true");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "film.mp4"));
}

TEST(Films, OfARunThatIsInterruptedAreWhole) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  Folder folder;
  Tandem run({"run", kExperiment, "--set", "framework.experiment.length=0", "--set", "framework.time.mode=realtime",
              "--film", "film.mkv", "--picture-size", "200"},
             folder.path());
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(folder.path() / "film.mkv.part"); }, 20));
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(), 130) << run.errors();
  const std::string frames =
      answer_of("ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 '" +
                (folder.path() / "film.mkv").string() + "'");
  EXPECT_GE(std::atoi(frames.c_str()), 1) << frames;
}

TEST(Films, EndSoonAfterCtrlCHoweverMuchIsLeftToDraw) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  Folder folder;
  const auto frames_of = [&](const std::string& film) {
    return std::atoi(answer_of("ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 '" +
                               (folder.path() / film).string() + "'")
                         .c_str());
  };
  Tandem run({"run", kExperiment, "--set", "framework.experiment.length=0", "--film", "film.mkv", "--picture-size",
              "1200", "--record", "run.record"},
             folder.path());  // its ticks are done much faster than its frames are drawn: thousands wait
  ASSERT_TRUE(eventually([&] { return text_of(folder.path() / "run.record.part").size() > 1'000'000; }, 120));
  run.signal(SIGINT);
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(30), 130) << run.errors();
  EXPECT_NE(run.errors().find("interrupted: pictures and film end after tick"), std::string::npos) << run.errors();
  EXPECT_GE(frames_of("film.mkv"), 1);

  Tandem film({"film", "run.record", "-o", "again.mkv", "--picture-size", "1200"}, folder.path());
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(folder.path() / "again.mkv.part"); }, 60));
  film.signal(SIGINT);
  EXPECT_EQ(film.wait(30), 130) << film.errors();
  EXPECT_GE(frames_of("again.mkv"), 1);
}

TEST(Pictures, AreRayTracedToo) {
  Folder folder;
  output_of(folder, {"run", kConfigs + "footbot_foraging.xml", "--seconds", "5", "--povray", "view.pov", "--quiet"});
  EXPECT_NE(text_of(folder.path() / "view.pov").find("camera {"), std::string::npos);
  if (!has_program("povray")) GTEST_SKIP() << "povray is not installed";
  output_of(folder, {"run", kConfigs + "footbot_foraging.xml", "--seconds", "5", "--povray", "small.png",
                     "--picture-size", "160", "--quiet"});
  EXPECT_EQ(text_of(folder.path() / "small.png").substr(1, 3), "PNG");
  EXPECT_EQ(text_of(folder.path() / "small.pov"), text_of(folder.path() / "view.pov"));
}

TEST(Pictures, ThatCannotBeDrawnAreClearErrors) {
  Folder folder;
  const auto fails = [&](std::vector<std::string> more, int code, const char* part) {
    more.insert(more.begin(), {"run", kExperiment, "--seconds", "2", "--quiet"});
    const std::string errors = output_of(folder, more, code);
    EXPECT_NE(errors.find(part), std::string::npos) << errors;
  };
  fails({"--picture", "p.svg", "--picture-at", "30"}, 1, "--picture-at 30: there are 20 ticks");
  fails({"--picture", "p.svg", "--picture-at", "1,x"}, 2, "--picture-at");
  fails({"--picture-at", "10"}, 2, "--picture");
  fails({"--picture", "p.svg", "--picture-region", "5,5,6,6"}, 1, "lies outside of the arena, which is -2,-2,2,2");
  fails({"--picture", "p.svg", "--picture-region", "1,1,0,2"}, 1, "left of the second one");
  fails({"--picture", "p.svg", "--picture-region", "1,1,2"}, 2, "--picture-region");
  fails({"--povray", "a.svg"}, 1, "must end in .pov");
  fails({"--povray", "/no/such/folder/a.pov"}, 1, "/no/such/folder");
  fails({"--film", "a.avi"}, 1, ".mp4, .mkv or .webp");
  fails({"--film", kExperiment + "/%06d.png"}, 1, "the folder");
  fails({"--film", "a/", "--film-every", "0"}, 2, "--film-every");
  fails({"--film", "/no/such/folder/a.mp4"}, 1, has_program("ffmpeg") ? "/no/such/folder" : "ffmpeg");
  const std::string errors = output_of(folder, {"run", kExperiment, "--steps", "1000000", "--film", "a/"}, 1);
  EXPECT_NE(errors.find("1000001 frames would take about 27.8 h"), std::string::npos) << errors;
  EXPECT_NE(errors.find("--film-every 11"), std::string::npos) << errors;
}

}  // namespace
}  // namespace tandem
