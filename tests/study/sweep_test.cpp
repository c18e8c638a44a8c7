// `tandem sweep` as a user runs it: whole tables, whatever happens on the way.
#include <gmock/gmock.h>
#include <random>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::eventually;
using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kExperiment = R"(<tandem>
  <framework><experiment length="LENGTH" ticks_per_second="10" random_seed="1"/></framework>
  <controllers>
    <epuck_diffusion id="walk" library="epuck_diffusion">
      <actuators><differential_steering/></actuators>
      <sensors><proximity implementation="noisy" noise_level="0.02"/></sensors>
      <params alpha="7.5" delta="0.1" velocity="5 cm/s"/>
    </epuck_diffusion>
  </controllers>
  <loop_functions library="test_measuring" label="measuring" gain="1"/>
  <arena size="3,3,1" escape="stop">
    <distribute>
      <position method="uniform" min="-1,-1,0" max="1,1,0"/>
      <orientation method="uniform" min="0,0,0" max="360,0,0"/>
      <entity quantity="4" max_trials="100"><e-puck id="ep"><controller config="walk"/></e-puck></entity>
    </distribute>
  </arena>
</tandem>
)";

/// How often the sweep is killed; TANDEM_KILLS says how often else.
int kills() {
  const char* const given = std::getenv("TANDEM_KILLS");
  return given == nullptr ? 40 : std::atoi(given);
}

/// A folder with an experiment of so many seconds.
class Sweep : public testing::Test {
 protected:
  void experiment(const std::string& length = "2", const std::string& name = "e.xml") {
    std::string text = kExperiment;
    text.replace(text.find("LENGTH"), 6, length);
    folder_.write(name, text);
  }
  void study(const std::string& content, const std::string& attributes = "") {
    folder_.write("s.xml", "<study " + attributes + ">\n  <experiment file=\"e.xml\"/>\n" + content + "</study>\n");
  }
  /// Runs the program to its end.
  int tandem(const std::vector<std::string>& arguments, double seconds = 60.0) {
    Tandem program(arguments, folder_.path());
    const int code = program.wait(seconds);
    output_ = program.output();
    errors_ = program.errors();
    return code;
  }
  std::string file(const std::string& name) const { return text_of(folder_.path() / name); }
  /// A table as CSV without its times, which are the last two columns.
  std::string without_times(const std::string& name) const {
    std::istringstream in(file(name));
    std::string all;
    for (std::string line; std::getline(in, line);) {
      for (int i = 0; i < 2; ++i) line.erase(line.rfind(','));
      all += line + "\n";
    }
    return all;
  }
  std::vector<std::string> lines(const std::string& name) const {
    std::istringstream in(file(name));
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }

  Folder folder_;
  std::string output_, errors_;
};

TEST_F(Sweep, MakesEveryRunAsTheRunCommandWould) {
  experiment();
  study(
      R"(<parameter path="loop_functions.gain" values="1, 2"/><seeds first="3" count="2"/><measures every="0.5 s"/>)");
  ASSERT_EQ(tandem({"sweep", "s.xml", "--jobs", "2"}), 0) << errors_;
  EXPECT_THAT(output_, HasSubstr("4 runs made"));
  const auto table = lines("s.csv");
  ASSERT_EQ(table.size(), 5U);
  EXPECT_EQ(table[0],
            "run,experiment,seed,gain,state,ended,failure,ticks,virtual_s,fingerprint,version,items,\"late, and "
            "\"\"odd\"\"\",wall_s,cpu_s");
  for (std::size_t run = 0; run < 4; ++run) {
    const std::string seed = run < 2 ? "3" : "4", gain = run % 2 == 0 ? "1" : "2";
    ASSERT_EQ(tandem({"run", "e.xml", "--seed", seed, "--set", "loop_functions.gain=" + gain, "--report", "-"}), 0);
    const std::string items = scenarios::json_value(output_, "items");
    EXPECT_THAT(table[run + 1],
                testing::StartsWith(std::to_string(run) + ",e," + seed + "," + gain + ",done,length,,20,2," +
                                    scenarios::json_value(output_, "state_hash") + ",1,"));
    EXPECT_THAT(table[run + 1], HasSubstr("," + std::to_string(std::stoi(items)) + ","));
  }
  const auto samples = lines("s.samples.csv");  // 4 a run of items, 3 of what comes later
  EXPECT_EQ(samples.size(), 1U + 4U * (4U + 3U));
  EXPECT_EQ(samples[1].substr(0, 12), "0,items,5,0.");
}

TEST_F(Sweep, RunsHaveThePartsThatTheirExperimentNames) {
  std::string text = kExperiment;
  text.replace(text.find("LENGTH"), 6, "2");
  text.replace(text.find("  <loop_functions"), 0, "  <plugins library=\"test_trouble\"/>\n");
  text.replace(text.find("</tandem>"), 0, "  <run><joiner what=\"none\" at=\"3\"/></run>\n");
  folder_.write("e.xml", text);
  study(R"(<parameter path="run.joiner.what" values="none, end, before"/><seeds first="1" count="2"/>)");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--jobs", "2"}), 3);
  EXPECT_THAT(output_, HasSubstr("part 'joiner', before_tick: cannot go on"));
  const auto table = lines("s.csv");
  ASSERT_EQ(table.size(), 7U);
  for (const std::size_t seed : {0U, 1U}) {
    EXPECT_THAT(table[1 + 3 * seed], HasSubstr(",none,done,length,,20,2,"));
    EXPECT_THAT(table[2 + 3 * seed], HasSubstr(",end,done,part,,3,0.3,"));
    EXPECT_THAT(table[3 + 3 * seed], HasSubstr(",before,failed,failed,"));
  }
}

TEST_F(Sweep, GivesTheSameTableForAnyNumberOfWorkersAndWithEveryRunApart) {
  experiment();
  study(R"(<parameter path="loop_functions.gain" values="1, 2, 3"/><seeds first="1" count="4"/>)");
  ASSERT_EQ(tandem({"sweep", "s.xml", "--jobs", "1", "--table", "one.sqlite"}), 0) << errors_;
  ASSERT_EQ(tandem({"sweep", "s.xml", "--jobs", "5", "--table", "five.sqlite"}), 0) << errors_;
  study(R"(<parameter path="loop_functions.gain" values="1, 2, 3"/><seeds first="1" count="4"/>)", "isolate=\"true\"");
  ASSERT_EQ(tandem({"sweep", "s.xml", "--jobs", "2", "--table", "apart.sqlite"}), 0) << errors_;
  EXPECT_EQ(lines("one.csv").size(), 13U);
  EXPECT_EQ(without_times("one.csv"), without_times("five.csv"));
  EXPECT_EQ(without_times("one.csv"), without_times("apart.csv"));
}

TEST_F(Sweep, LosesNothingThatWasMadeWhenItIsKilledAtAnyMoment) {
  experiment();
  study(R"(<parameter path="loop_functions.gain" from="1" to="5" count="5"/><seeds first="1" count="60"/>
           <measures every="0.5 s"/>)");
  const auto begun = std::chrono::steady_clock::now();
  ASSERT_EQ(tandem({"sweep", "s.xml", "--table", "whole.sqlite"}), 0) << errors_;
  const std::chrono::duration<double> takes = std::chrono::steady_clock::now() - begun;
  const std::string whole = without_times("whole.csv"), samples = file("whole.samples.csv");
  ASSERT_EQ(lines("whole.csv").size(), 301U);
  std::mt19937 chance(7);
  int killed = 0, tables = 0;
  for (; killed < kills(); ++tables) {
    const std::string table = "t" + std::to_string(tables) + ".sqlite", csv = "t" + std::to_string(tables);
    for (bool done = false; !done;) {
      Tandem program({"sweep", "s.xml", "--resume", "--table", table}, folder_.path());
      const double after_s = std::uniform_real_distribution<>(0.0, 1.2 * takes.count())(chance);
      const int early = program.wait(after_s);
      done = early == 0;
      if (done) break;
      ASSERT_EQ(early, -1000) << program.errors();
      program.signal(SIGKILL);
      const int end = program.wait();
      done = end == 0;  // it had just ended by itself
      if (done) break;
      ASSERT_EQ(end, -SIGKILL) << program.errors();
      if (++killed % 10 != 0) continue;
      ASSERT_EQ(tandem({"sweep", "s.xml", "--resume", "--table", table}), 0) << errors_;
      done = true;
    }
    EXPECT_EQ(without_times(csv + ".csv"), whole);
    EXPECT_EQ(file(csv + ".samples.csv"), samples);
  }
}

TEST_F(Sweep, EndsInOrderAtCtrlCAndGoesOn) {
  experiment("20000");  // seconds of work: Ctrl-C comes in the middle
  study(R"(<seeds first="1" count="200"/>)");
  Tandem program({"sweep", "s.xml", "--jobs", "2"}, folder_.path());
  const auto begun = [&] { return std::filesystem::exists(folder_.path() / "s.sqlite-wal"); };
  ASSERT_TRUE(eventually(begun, 30.0)) << program.errors();
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 130);
  EXPECT_THAT(program.errors(), HasSubstr("of 200 runs are missing; go on with: tandem sweep s.xml --resume"));
  const std::size_t made = lines("s.csv").size();
  EXPECT_LT(made, 201U);
  experiment("2");  // another file
  EXPECT_EQ(tandem({"sweep", "s.xml", "--resume"}), 1);
  EXPECT_THAT(errors_, HasSubstr("have been changes: 'e.xml'"));
  EXPECT_EQ(tandem({"sweep", "s.xml", "--resume", "--accept-changes"}), 0) << errors_ << output_;
  EXPECT_EQ(lines("s.csv").size(), 201U);
}

TEST_F(Sweep, ARunWithAStepThatDoesNotReturnFailsByItself) {
  experiment();
  study(R"(<set path="loop_functions.loop_seed" value="2"/><seeds first="1" count="3"/>)", "step_limit=\"2\"");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--jobs", "2"}), 3);
  EXPECT_THAT(output_, HasSubstr("2 done, 1 failed"));
  EXPECT_THAT(output_,
              AllOf(HasSubstr("has not returned for 2 s, the study's step_limit"), HasSubstr("hook 'measuring'")));
}

TEST_F(Sweep, SaysHowFarItIsWhereThereIsNoTerminal) {
  experiment();
  study(R"(<set path="loop_functions.loop_seed" value="2"/><seeds first="1" count="4"/>)", "step_limit=\"5\"");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--jobs", "2"}), 3);
  EXPECT_THAT(errors_, testing::ContainsRegex("sweep: (50|75) %, about "))
      << "the worker that waits may have been given two";
  EXPECT_THAT(errors_, Not(HasSubstr("\r"))) << "no bar";
}

TEST_F(Sweep, RunsThatFailForOneReasonAreOneLine) {
  folder_.write("e.xml", R"(<tandem>
  <framework><experiment length="2" ticks_per_second="10"/></framework>
  <controllers><troublemaker id="t" library="test_trouble"><actuators><differential_steering/></actuators>
    <params what="throw" at="5"/></troublemaker></controllers>
  <arena size="4,4,1"><e-puck id="ep"><body position="0,0,0"/><controller config="t"/></e-puck>
    <e-puck id="er"><body position="1,0,0"/><controller config="t"/></e-puck></arena>
</tandem>)");
  study(R"(<seeds first="1" count="5"/>)");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--jobs", "2"}), 3);
  EXPECT_THAT(output_, HasSubstr("0 done, 5 failed"));
  EXPECT_THAT(output_,
              testing::ContainsRegex("run [0-4] \\(and 4 more\\) failed: controller of robot 'ep' \\(and 1 more"
                                     "\\) threw at tick 5"));
  EXPECT_EQ(output_.find(" failed: "), output_.rfind(" failed: ")) << output_;
}

TEST_F(Sweep, KeepsTheTableOfAnotherSweep) {
  experiment();
  study(R"(<seeds first="1" count="2"/>)");
  folder_.write("s.csv", "mine");
  ASSERT_EQ(tandem({"sweep", "s.xml"}), 0) << errors_;
  EXPECT_THAT(errors_, HasSubstr("the old 's.csv' is kept as 's.csv.bak'"));
  EXPECT_EQ(file("s.csv.bak"), "mine");
  EXPECT_EQ(lines("s.csv").size(), 3U);
  EXPECT_EQ(tandem({"sweep", "s.xml"}), 1);
  EXPECT_THAT(errors_, HasSubstr("there is a table 's.sqlite' already: --resume makes the runs that it lacks"));
  study(R"(<seeds first="1" count="3"/>)");
  ASSERT_EQ(tandem({"sweep", "s.xml", "--resume"}), 0) << errors_;
  EXPECT_EQ(lines("s.csv").size(), 4U);
  EXPECT_EQ(file("s.csv.bak"), "mine") << "its own table is no other's";
}

TEST_F(Sweep, GoesOnPastRunsThatThrowCrashAndHang) {
  experiment();
  const std::string rest = R"(<seeds first="1" count="9"/>)";
  study(R"(<set path="loop_functions.throw_seed" value="3"/><set path="loop_functions.crash_seed" value="5"/>
           <set path="loop_functions.loop_seed" value="7"/><set path="loop_functions.mended" value="mended"/>)" +
            rest,
        "time_limit=\"8\"");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--jobs", "2"}), 3);
  EXPECT_THAT(output_, HasSubstr("9 runs made"));
  EXPECT_THAT(output_, HasSubstr("6 done, 3 failed"));
  EXPECT_THAT(output_, HasSubstr("run 2 failed: hook 'measuring' threw in after_step at tick 3: lost count"));
  EXPECT_THAT(output_,
              HasSubstr("hook 'measuring' (library 'test_measuring') in after_step at tick 3 crashed: SIGSEGV"));
  EXPECT_THAT(output_, HasSubstr("run 6 failed: took longer than the study's time limit of 8 s"));
  EXPECT_THAT(output_, HasSubstr("tandem run e.xml --seed 3 --set loop_functions.throw_seed=3"));
  EXPECT_THAT(output_, HasSubstr("again: tandem sweep s.xml --resume --retry-failed"));

  folder_.write("mended", "");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--resume"}), 3) << "nothing is left to do, but not all is done";
  EXPECT_THAT(output_, HasSubstr("0 runs made"));
  EXPECT_THAT(output_, HasSubstr("3 runs failed before; again: tandem sweep s.xml --resume --retry-failed"));
  EXPECT_EQ(tandem({"sweep", "s.xml", "--resume", "--retry-failed"}), 3);
  EXPECT_THAT(output_, HasSubstr("3 runs made"));
  EXPECT_THAT(output_, HasSubstr("1 done, 2 failed"));
  EXPECT_EQ(lines("s.csv").size(), 10U);
}

TEST_F(Sweep, TakesMoreSeedsLater) {
  experiment();
  study(R"(<parameter path="loop_functions.gain" values="1, 2"/><seeds first="1" count="3"/>)");
  ASSERT_EQ(tandem({"sweep", "s.xml"}), 0) << errors_;
  const auto before = lines("s.csv");
  study(R"(<parameter path="loop_functions.gain" values="1, 2"/><seeds first="1" count="5"/>)");
  ASSERT_EQ(tandem({"sweep", "s.xml", "--resume"}), 0) << errors_;
  EXPECT_THAT(output_, HasSubstr("4 runs made"));
  const auto after = lines("s.csv");
  ASSERT_EQ(after.size(), 11U);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin()));
  study(R"(<parameter path="loop_functions.gain" values="1, 3"/><seeds first="1" count="5"/>)");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--resume"}), 1);
  EXPECT_THAT(errors_, HasSubstr("its run 1 is another one now"));
}

TEST_F(Sweep, SaysWhatIsWrongBeforeItBegins) {
  experiment();
  const auto refused = [&](const std::string& content, const std::string& why) {
    study(content);
    EXPECT_EQ(tandem({"check", "s.xml"}), 1) << content;
    EXPECT_THAT(errors_, HasSubstr(why));
    EXPECT_EQ(tandem({"sweep", "s.xml"}), 1) << content;
    EXPECT_THAT(errors_, HasSubstr(why));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "s.sqlite"));
  };
  refused("<parameter path=\"controllers.epuck_difusion.params.alpha\" values=\"1\"/>",
          "s.xml:3: error: parameter alpha = 1, in experiment 'e': <controllers> has no epuck_difusion");
  refused("<parameter path=\"controllers.epuck_diffusion.params.alpha\" values=\"1, 2, many\"/>",
          "s.xml:3: error: parameter alpha = many, in experiment 'e'");
  refused("<parameter path=\"loop_functions.gane\" values=\"1, 2\"/>", "s.xml:3: error: parameter gane = 1");
  refused(R"(<parameter path="loop_functions.gain" name="Seed" values="1, 2"/>)", "every table has a column 'Seed'");
  refused(R"(<parameter path="loop_functions.gain" name="a" values="1"/>
             <parameter path="framework.experiment.length" name="A" values="1"/>)",
          "a second parameter 'a'; the first is on line 3");
  refused(R"(<seeds values="1, 2, 1"/>)", "'1' stands twice in the list");
  refused(R"(<seeds first="2" values="1"/>)", "either first and count, or values");
  refused(R"(<parameter path="loop_functions.gain" values="1, 2, 1"/>)", "'1' stands twice in the list");
  refused("<set path=\"framework.experiment.length\" value=\"-2\"/>",
          "s.xml:3: error: <set> framework.experiment.length = -2");
  refused("<set path=\"loop_functions.library\" value=\"no_such_library\"/>", "no_such_library");
  refused(
      "<parameter path=\"loop_functions.gain\" from=\"0\" to=\"1\" count=\"1000\"/><seeds first=\"1\" "
      "count=\"10000000\"/>",
      "a thousand million is the most");
  study(
      "<parameter path=\"loop_functions.gain\" from=\"0\" to=\"1\" count=\"1000\"/><seeds first=\"1\" "
      "count=\"10000\"/>");
  EXPECT_EQ(tandem({"check", "s.xml"}), 0) << errors_;
  EXPECT_THAT(output_, HasSubstr("10000000 runs"));
  EXPECT_EQ(tandem({"sweep", "s.xml"}), 1);
  EXPECT_THAT(errors_, HasSubstr("the study has 10000000 runs; if they are meant, add --yes"));
  study("");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--table", "/nowhere/t.sqlite"}), 1);
  EXPECT_EQ(tandem({"sweep", "s.xml"}), 0) << errors_;
  EXPECT_EQ(tandem({"sweep", "s.xml"}), 1);
  EXPECT_THAT(errors_, HasSubstr("there is a table 's.sqlite' already: --resume makes the runs that it lacks"));
  EXPECT_EQ(tandem({"describe", "latin_hypercube"}), 0);
}

TEST_F(Sweep, SaysAtOnceThatAMeasureIsNotThere) {
  experiment();
  study(R"(<measures names="items, itmes, no*"/>)");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--table", "other.sqlite"}), 0);
  EXPECT_THAT(errors_, HasSubstr("warning: run 0 has no measure 'itmes', which the study asks for"));
  EXPECT_THAT(errors_, HasSubstr("'no*'"));
  EXPECT_THAT(errors_, Not(HasSubstr("'items'")));
}

TEST_F(Sweep, SaysHowToGoOnInItsOwnTable) {
  experiment();
  study(R"(<set path="loop_functions.throw_seed" value="1"/>)");
  EXPECT_EQ(tandem({"sweep", "s.xml", "--table", "my table.sqlite"}), 3);
  EXPECT_THAT(output_, HasSubstr("again: tandem sweep s.xml --resume --table 'my table.sqlite' --retry-failed"));
}

TEST_F(Sweep, IsDrawnAndJudged) {
  experiment();
  study(
      R"(<parameter path="loop_functions.gain" values="1, 2"/><seeds first="1" count="9"/><measures every="0.5 s"/>)");
  ASSERT_EQ(tandem({"sweep", "s.xml"}), 0) << errors_;
  ASSERT_EQ(tandem({"plot", "s.sqlite", "--measure", "items", "-o", "time.svg"}), 0) << errors_;
  EXPECT_THAT(file("time.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(output_, HasSubstr("items, time 2 s: 1 (median "));
  EXPECT_THAT(output_, HasSubstr(", n = 9) differ, 2 is larger in 100 % of pairs of runs: Mann-Whitney U = 0, p "));
  ASSERT_EQ(tandem({"plot", "s.sqlite", "--measure", "items", "--over", "gain", "--show", "box", "-o", "box.png"}), 0);
  EXPECT_EQ(file("box.png").substr(1, 3), "PNG");
  ASSERT_EQ(tandem({"plot", "s.sqlite", "--measure", "items", "--over", "gain", "--show", "mean", "-o", "mean.pdf"}),
            0);
  EXPECT_EQ(file("mean.pdf").substr(0, 4), "%PDF");
  EXPECT_EQ(tandem({"plot", "s.sqlite"}), 1);
  EXPECT_THAT(errors_, HasSubstr("--measure says what to draw; the table has: items, late"));
  EXPECT_EQ(tandem({"plot", "s.sqlite", "--measure", "itmes"}), 1);
  EXPECT_THAT(errors_, HasSubstr("Did you mean 'items'?"));
  EXPECT_EQ(tandem({"plot", "s.sqlite", "--measure", "items", "--by", "gian"}), 1);
  EXPECT_THAT(errors_, HasSubstr("the table has no column 'gian'"));
  EXPECT_EQ(tandem({"plot", "s.sqlite", "--measure", "items", "--where", "gain=3"}), 1);
  EXPECT_THAT(errors_, HasSubstr("no run has '3' in the column 'gain'; it has: 1, 2"));
  EXPECT_EQ(tandem({"plot", "none.sqlite"}), 1);
  EXPECT_THAT(errors_, HasSubstr("table 'none.sqlite': there is no such file"));
  EXPECT_EQ(tandem({"plot", "s.xml", "--measure", "items"}), 1);
  EXPECT_THAT(errors_, HasSubstr("no table of a study"));
}

TEST_F(Sweep, ComparesRunsOfOneSeedInPairs) {
  experiment();
  study(
      R"(<parameter path="loop_functions.gain" values="1, 2"/><seeds first="1" count="8"/><measures every="0.5 s"/>)");
  ASSERT_EQ(tandem({"sweep", "s.xml"}), 0) << errors_;
  const std::vector<std::string> plot = {"plot", "s.sqlite", "--measure", "items", "--difference"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), plot.begin(), plot.end());
    return more;
  };
  ASSERT_EQ(tandem(with({"1", "-o", "pairs.svg"})), 0) << errors_;
  EXPECT_THAT(file("pairs.svg"), HasSubstr("2 − 1"));
  EXPECT_THAT(output_, HasSubstr("items, time 2 s: 2 and 1 differ in 8 matched pairs, 2 - 1 is "));
  EXPECT_THAT(output_, HasSubstr("2 is larger in 8 and smaller in 0: Wilcoxon signed-rank V = 36, p = "));
  EXPECT_EQ(tandem(with({"3"})), 1);
  EXPECT_THAT(errors_, HasSubstr("there is no group '3'; there are: 1, 2"));
}

TEST_F(Sweep, DrawsTheWaysOfTheCaseStudysShuttle) {
  const std::string file_name = std::string(test::kSourceDir) + "/studies/shuttle.xml";
  ASSERT_EQ(tandem({"sweep", file_name, "--table", "shuttle.sqlite"}), 0) << errors_;
  ASSERT_EQ(tandem({"plot", "shuttle.sqlite", "--measure", "y_m", "--over", "x_m", "--equal-axes", "-o", "ways.svg"}),
            0)
      << errors_;
  EXPECT_THAT(file("ways.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(output_, HasSubstr("slanted: y_m and x_m in 61 runs go against each other"));
  ASSERT_EQ(tandem({"plot", "shuttle.sqlite", "--measure", "odometry_error_m", "--show", "runs", "-o", "error.svg"}),
            0);
  EXPECT_THAT(output_, HasSubstr("slanted is larger in 100 % of pairs of runs"));  // and so all draw to their left
  EXPECT_EQ(tandem({"plot", "shuttle.sqlite", "--measure", "y_m", "--over", "x_m", "--difference", "ideal"}), 1);
  EXPECT_THAT(errors_, HasSubstr("at the same place of x"));
}

TEST_F(Sweep, FindsTheStudiesThatComeWithItGood) {
  int studies = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(test::kSourceDir) + "/studies")) {
    if (entry.path().extension() != ".xml") continue;
    EXPECT_EQ(tandem({"check", entry.path().string()}), 0) << entry.path() << "\n" << errors_;
    ++studies;
  }
  EXPECT_GE(studies, 2);
}

TEST_F(Sweep, GivesEveryRunFilesOfItsOwn) {
  experiment();
  study(R"(<set path="loop_functions.mended" value="file_{run}_{seed}"/><seeds values="8, 5"/>)");
  EXPECT_EQ(tandem({"sweep", "s.xml"}), 0) << errors_;
  EXPECT_EQ(lines("s.csv").size(), 3U);
}

}  // namespace
}  // namespace tandem
