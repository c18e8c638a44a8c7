// Records as a user meets them: `tandem run --record`, <record>, `tandem export`.
#include <array>
#include <cstdlib>
#include <gtest/gtest.h>
#include <regex>
#include <set>
#include <sstream>

#include "core/record/record_reader.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::json_value;
using scenarios::Tandem;
using scenarios::text_of;

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";

/// Runs and gives what was printed; errors where the exit code is another.
std::string output_of(const Folder& folder, const std::vector<std::string>& arguments, int code = 0) {
  Tandem tandem(arguments, folder.path());
  EXPECT_EQ(tandem.wait(), code) << tandem.errors();
  return code == 0 ? tandem.output() : tandem.errors();
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(Records, WhoseTablesTakeLongSayHowFarTheyAre) {
  Folder folder;
  output_of(folder, {"run", kConfigs + "epuck_diffusion.xml", "--quiet", "--seconds", "60", "--record", "run.record"});
  // Whoever takes the table keeps the program waiting.
  const std::string command = "cd '" + folder.path().string() + "' && '" + test::kBuildDir +
                              "/bin/tandem' export run.record --csv - 2>said | (sleep 3; cat >table)";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(std::regex_search(text_of(folder.path() / "said"), std::regex("^export: [0-9]+ %, about .* left\n")))
      << text_of(folder.path() / "said");
  EXPECT_EQ(lines_of(text_of(folder.path() / "table")), 1U + 600U * 50U);
}

TEST(Records, TablesKeepTheFileThatStoodInTheirPlace) {
  Folder folder;
  output_of(folder, {"run", kConfigs + "epuck_diffusion.xml", "--quiet", "--seconds", "1", "--record", "run.record"});
  for (const auto& [option, name] : {std::pair("--csv", "t.csv"), std::pair("--dump", "d.csv"),
                                     std::pair("--report", "r.json"), std::pair("--hdf5", "t.h5")}) {
    folder.write(name, "mine");
    Tandem made({"export", "run.record", option, name}, folder.path());
    ASSERT_EQ(made.wait(), 0) << made.errors();
    EXPECT_EQ(made.errors(), "the old '" + std::string(name) + "' is kept as '" + name + ".bak'\n");
    EXPECT_EQ(text_of(folder.path() / (std::string(name) + ".bak")), "mine") << option;
    EXPECT_NE(text_of(folder.path() / name), "mine") << option;
  }
}

TEST(Records, HoldPosesOfEveryTickAndBecomeTables) {
  Folder folder;
  output_of(folder, {"run", kConfigs + "epuck_diffusion.xml", "--seconds", "3", "--record", "run.record",
                     "--trajectory", "poses.csv", "--set", "record.ports=proximity"});
  const std::string contents = output_of(folder, {"export", "run.record"});
  for (const char* part : {"epuck_diffusion, seed 124", "'pose': ticks 0 to 29, 30 of them, 50 rows each; x_m",
                           "'sensor proximity'", "end           length"})
    EXPECT_NE(contents.find(part), std::string::npos) << part << " in " << contents;

  const std::string table = output_of(folder, {"export", "run.record", "--csv", "-"});
  EXPECT_EQ(lines_of(table), 1U + 30U * 50U);
  // Of ep7 the same places as in the table of poses, which the run wrote itself.
  std::istringstream mine(table), theirs(text_of(folder.path() / "poses.csv"));
  std::vector<std::string> a, b;
  const auto keep = [](std::istream& text, std::vector<std::string>& lines) {
    for (std::string line; std::getline(text, line);) {
      if (line.find(",ep7,") != std::string::npos) lines.push_back(line.substr(0, line.rfind(',')));
    }
  };
  keep(mine, a);
  keep(theirs, b);
  EXPECT_EQ(a.size(), 30U);
  EXPECT_EQ(a, b);

  const std::string some =
      output_of(folder, {"export", "run.record", "--csv", "-", "--table", "sensor proximity", "--entities", "ep1,ep2*",
                         "--from", "10", "--until", "20", "--every", "5"});
  EXPECT_EQ(lines_of(some), 1U + 3U * 12U) << some;  // ep1, ep2, ep20 to ep29
  EXPECT_NE(some.find("distance_m[7]"), std::string::npos);
}

TEST(Records, AreDumpedWhereTheyHoldTheState) {
  Folder folder;
  output_of(folder, {"run", kConfigs + "epuck_diffusion.xml", "--seconds", "2", "--record", "run.record", "--dump",
                     "run.csv", "--dump-every", "10", "--set", "record.ports=proximity"});
  output_of(folder, {"export", "run.record", "--dump", "record.csv", "--from", "9", "--every", "10"});
  const auto readings = [&](const char* file) {
    std::istringstream text(text_of(folder.path() / file));
    std::multiset<std::string> lines;
    for (std::string line; std::getline(text, line);) {
      if (line.find(",sensor proximity,distance[") != std::string::npos) lines.insert(line);
    }
    return lines;
  };
  EXPECT_GT(readings("run.csv").size(), 50U);
  EXPECT_EQ(readings("run.csv"), readings("record.csv"));
  EXPECT_NE(text_of(folder.path() / "record.csv").find("\n20,robot ep7,body,x,"), std::string::npos);
  EXPECT_NE(output_of(folder, {"export", "run.record", "--dump", "none.csv", "--from", "99"}, 1).find("no such ticks"),
            std::string::npos);
}

/// A row's time is that of its state: what falls lies where the closed form has it at that time, and at no other.
TEST(Records, HoldWhereThingsAreAtTheTimeOfTheRow) {
  Folder folder;
  folder.write("fall.xml", R"(<tandem version="1">
  <framework><experiment length="1" ticks_per_second="10" random_seed="1"/></framework>
  <controllers/>
  <arena size="4,4,20" center="0,0,10">
    <box id="stone" size="0.1,0.1,0.1" movable="true" mass="1"><body position="0,0,8" orientation="0,0,0"/></box>
  </arena>
  <physics_engines><dynamics3d id="space" iterations="100"/></physics_engines>
</tandem>
)");
  output_of(folder, {"run", "fall.xml", "--record", "run.record"});
  output_of(folder, {"export", "run.record", "--csv", "fall.csv", "--table", "object pose"});
  std::istringstream rows(text_of(folder.path() / "fall.csv"));
  std::string line;
  std::getline(rows, line);
  ASSERT_EQ(line, "tick,time_s,id,x_m,y_m,z_m,heading_rad");
  constexpr double kGravity_m_s2 = 9.81;
  int count = 0;
  for (; std::getline(rows, line); ++count) {
    std::array<std::string, 7> cells;
    std::istringstream text(line);
    for (std::string& cell : cells) std::getline(text, cell, ',');
    const double t_s = std::stod(cells[1]);
    // The engine's steps of 1 ms are 5 mm off in a second; a tick is 0.98 m.
    EXPECT_NEAR(std::stod(cells[5]), 8.0 - 0.5 * kGravity_m_s2 * t_s * t_s, 6e-3) << line;
  }
  EXPECT_EQ(count, 10);
}

/// What Debian's Python says; h5py is a reader of HDF5 that is none of ours.
std::string python(const Folder& folder, const std::string& program) {
  folder.write("look.py", program);
  const std::string out = (folder.path() / "look.txt").string();
  const std::string command = "cd " + folder.path().string() + " && /usr/bin/python3 look.py > " + out + " 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << text_of(out);
  return text_of(out);
}

TEST(Records, BecomeDataSetsThatH5pyReads) {
  if (std::system("/usr/bin/python3 -c 'import h5py' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3-h5py here";
  Folder folder;
  output_of(folder, {"run", kConfigs + "epuck_diffusion.xml", "--seconds", "3", "--record", "run.record", "--set",
                     "record.ports=proximity,differential_steering"});
  output_of(folder, {"export", "run.record", "--hdf5", "all.h5"});
  output_of(folder, {"export", "run.record", "--hdf5", "some.h5", "--table", "pose", "--fields", "x,heading",
                     "--entities", "ep1,ep2*", "--from", "10", "--until", "20", "--every", "5"});
  output_of(folder, {"export", "run.record", "--csv", "poses.csv"});
  const std::string said = python(folder, R"(
import csv, h5py, numpy
f = h5py.File("all.h5")
print(f["pose/x"].shape, f["pose/x"].attrs["unit"], f.attrs["experiment"], f.attrs["seed"])
print(f["sensor/proximity/distance"].shape, f["actuator/differential_steering/left"].shape)
ids = list(f["pose/ids"].asstr()[:])
rows = list(csv.DictReader(open("poses.csv")))
worst = 0.0
for row in rows:
    t, i = int(row["tick"]), ids.index(row["id"])
    for name, column in ("x", "x_m"), ("y", "y_m"), ("z", "z_m"), ("heading", "heading_rad"):
        worst = max(worst, abs(f["pose"][name][t, i] - float(row[column]))) if t % 10 == 0 else worst
print(len(rows), worst < 1e-8, numpy.all(f["pose/tick"][:] == numpy.arange(30)), numpy.isclose(f["pose/time"][29], 3.0))
g = h5py.File("some.h5")
print(sorted(g), sorted(g["pose"]), list(g["pose/tick"][:]), g["pose/x"].shape, numpy.isnan(g["pose/x"][:]).any())
)");
  EXPECT_EQ(said,
            "(30, 50) m epuck_diffusion 124\n"
            "(30, 50, 8) (30, 50)\n"
            "1500 True True True\n"
            "['events', 'pose'] ['heading', 'ids', 'tick', 'time', 'x'] [10, 15, 20] (3, 12) False\n");
}

TEST(Records, ThatCannotBecomeHdf5AreClearErrorsAndLeaveTheOldFile) {
  Folder folder;
  output_of(folder, {"run", kConfigs + "epuck_diffusion.xml", "--seconds", "1", "--record", "r"});
  folder.write("old.h5", "old");
  const auto fails = [&](const std::vector<std::string>& arguments, const char* part) {
    const std::string errors = output_of(folder, arguments, 1);
    EXPECT_NE(errors.find(part), std::string::npos) << errors;
  };
  fails({"export", "r", "--hdf5", "old.h5", "--table", "poses"}, "Did you mean 'pose'");
  fails({"export", "r", "--hdf5", "old.h5", "--fields", "headin"}, "Did you mean 'heading'");
  fails({"export", "r", "--hdf5", "/dev/full"}, "must be a file");
  fails({"export", "r", "--hdf5", "/no/such/folder/x.h5"}, "No such file");
  fails({"export", "r", "--hdf5", "r"}, "record");
  EXPECT_EQ(text_of(folder.path() / "old.h5"), "old");
}

TEST(Records, ChangeNoBitOfTheRun) {
  Folder folder;
  for (const char* file : {"epuck_diffusion.xml", "footbot_gripping.xml"}) {
    const auto hash = [&](std::vector<std::string> more) {
      std::vector<std::string> arguments = {"run", kConfigs + file, "--seconds", "5", "--threads",
                                            "2",   "--report",      "-"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      return json_value(output_of(folder, arguments), "state_hash");
    };
    EXPECT_EQ(hash({}),
              hash({"--record", "run.record", "--set", "record.ports=*", "--set", "record.fingerprint_every=3"}));
  }
}

TEST(Records, KeepTheReportOfTheirRun) {
  Folder folder;
  output_of(folder, {"run", kConfigs + "epuck_diffusion.xml", "--seconds", "3", "--record", "r", "--report", "a.json"});
  output_of(folder, {"export", "r", "--report", "b.json"});
  const std::string of_run = text_of(folder.path() / "a.json"), of_record = text_of(folder.path() / "b.json");
  for (const char* name : {"experiment", "ended", "state_hash", "seed"})
    EXPECT_EQ(json_value(of_record, name), json_value(of_run, name)) << name;
  std::string bytes = text_of(folder.path() / "r");
  folder.write("cut", bytes.substr(0, bytes.size() / 2));
  EXPECT_NE(output_of(folder, {"export", "cut", "--report", "b.json"}, 1).find("has no end"), std::string::npos);
  EXPECT_EQ(text_of(folder.path() / "b.json"), of_record);
}

TEST(Records, OfAKilledRunAreReadable) {
  Folder folder;
  Tandem run({"run", kConfigs + "epuck_diffusion.xml", "--set", "framework.experiment.length=0", "--set",
              "framework.time.mode=realtime", "--record", "run.record"},
             folder.path());
  // What a record begins with says nothing of its ticks: the run goes on until some of them can be read.
  const auto rows = [&] {
    Tandem tandem({"export", "run.record.part", "--csv", "-"}, folder.path());
    return tandem.wait() == 0 ? lines_of(tandem.output()) : 0;
  };
  ASSERT_TRUE(scenarios::eventually([&] { return rows() > 50; }, 60));
  run.signal(SIGKILL);
  EXPECT_EQ(run.wait(), -SIGKILL);
  EXPECT_NE(output_of(folder, {"export", "run.record.part"}).find("the run was killed"), std::string::npos);
  EXPECT_GT(rows(), 50U);
}

TEST(Records, AreAskedForInTheFileToo) {
  Folder folder;
  std::string text = text_of(kConfigs + "epuck_diffusion.xml");
  const std::size_t end = text.rfind("</tandem>") != std::string::npos ? text.rfind("</tandem>") : text.rfind("</");
  text.insert(end, R"(<record path="mine.record" entities="ep1*" every="10" fingerprint_every="10"/>)");
  folder.write("mine.xml", text);
  output_of(folder, {"run", "mine.xml", "--seconds", "3"});
  auto reader = core::RecordReader::open((folder.path() / "mine.record").string());
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  std::size_t rows = 0, fingerprints = 0;
  while (const auto entry = reader.value().next()) {
    if (entry->type == core::RecordBlock::Fingerprint) ++fingerprints;
    if (!entry->rows || entry->tick < 0) continue;
    EXPECT_EQ(entry->rows->size(), 11U);  // ep1, ep10 to ep19
    EXPECT_EQ(entry->tick % 10, 0);
    ++rows;
  }
  EXPECT_EQ(rows, 3U);
  EXPECT_EQ(fingerprints, 3U);
}

TEST(Records, ThatCannotBeMadeOrReadAreClearErrors) {
  Folder folder;
  const std::string experiment = kConfigs + "epuck_diffusion.xml";
  const auto fails = [&](const std::vector<std::string>& arguments, int code, const char* part) {
    const std::string errors = output_of(folder, arguments, code);
    EXPECT_NE(errors.find(part), std::string::npos) << errors;
  };
  fails({"run", experiment, "--record", "/no/such/folder/r"}, 1, "/no/such/folder");
  fails({"run", experiment, "--record", experiment}, 1, "the experiment");
  fails({"run", experiment, "--record", "r", "--set", "record.ports=proximty"}, 1, "did you mean 'proximity'");
  fails({"run", experiment, "--record", "r", "--set", "record.entities=ep1,,ep2"}, 1, "separated by commas");
  fails({"run", experiment, "--seconds", "1", "--record", "/dev/full"}, 3, "it is lost from tick");
  fails({"export", "nowhere"}, 1, "there is no such file");
  fails({"export", experiment}, 1, "is no record");
  output_of(folder, {"run", experiment, "--seconds", "1", "--record", "r"});
  fails({"export", "r", "--csv", "-", "--table", "sensor proximit"}, 1, "it has 'pose'");
  fails({"export", "r", "--every", "0"}, 2, "every");
}

}  // namespace
}  // namespace tandem
