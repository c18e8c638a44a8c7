// Main program of the tests that mostly wait (WAITS): gives each test a fair trial.
//
// These tests judge what programs do in real time, and a program that gets no processor does nothing. So each test runs
// in a process of its own, while this one watches how long the threads of all its programs wait for a processor, by
// the system's own account. A test that fails although none had to wait has failed. A failure in a trial in which one
// had to wait proves nothing: the trial is void, and there is another one. A test all of whose trials were void has no
// verdict: it is not failed, and the program ends with 77 (skipped, for ctest).
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <gmock/gmock.h>

#include "hal/processor_waits.hpp"
#include "tests/scenarios/process.hpp"

namespace {

using namespace tandem::scenarios;
namespace hal = tandem::hal;

constexpr int kMostTrials = 6;
constexpr int kNoVerdict = 77;
constexpr const char* kTrial = "TANDEM_TRIAL";  // in the environment of a trial and all its programs: which it is
constexpr auto kSample = std::chrono::milliseconds(200);
/// What a thread that wants to run may wait between two samples: robots are asked every 100 ms, and may be silent
/// once.
constexpr long long kMostWaiting_ns = 60'000'000;

/// This program, with these arguments more; -1: it cannot be started.
pid_t start(std::vector<std::string> words, const std::vector<std::string>& more, const std::string& mark, int output) {
  words.insert(words.end(), more.begin(), more.end());
  std::vector<char*> argv, environment;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::string marked = mark;
  for (char** e = environ; *e != nullptr; ++e) environment.push_back(*e);
  environment.push_back(marked.data());
  environment.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (output >= 0) posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  pid_t process = -1;
  if (posix_spawn(&process, "/proc/self/exe", &actions, nullptr, argv.data(), environment.data()) != 0) process = -1;
  posix_spawn_file_actions_destroy(&actions);
  return process;
}

std::string mark_of(int trial) {
  return std::string(kTrial) + "=" + std::to_string(getpid()) + "." + std::to_string(trial) + ".";
}

/// "Suite.Name" of all tests that the arguments choose, or "Suite.*".
std::vector<std::string> chosen(const std::vector<std::string>& words) {
  std::FILE* const file = std::tmpfile();
  const pid_t process = start(words, {"--gtest_list_tests"}, mark_of(0), fileno(file));
  int status = 0;
  waitpid(process, &status, 0);
  std::rewind(file);
  std::vector<std::string> all;
  std::string suite;
  for (char line[4096]; std::fgets(line, sizeof line, file) != nullptr;) {
    const std::string text(line, std::strcspn(line, "#\n"));
    const std::string name = text.substr(0, text.find_last_not_of(' ') + 1);
    if (name.ends_with('.')) suite = name;
#ifdef TANDEM_ONE_STORY  // all tests of a suite judge one story, which is told once
    if (name.ends_with('.')) all.push_back(suite + "*");
#else
    if (name.starts_with("  ")) all.push_back(suite + name.substr(2));
#endif
  }
  std::fclose(file);
  return all;
}

enum class Verdict { Passed, Failed, None };

Verdict try_fairly(const std::vector<std::string>& words, const std::string& test) {
  static int trials = 0;
  for (int i = 1; i <= kMostTrials; ++i) {
    const std::string mark = mark_of(++trials);
    hal::ProcessorWaits waits;
    const pid_t process = start(words, {"--gtest_filter=" + test}, mark, -1);
    if (process < 0) return Verdict::Failed;
    int status = 0;
    while (waitpid(process, &status, WNOHANG) == 0) {
      for (const pid_t one : processes_marked(mark)) waits.look(one);
      std::this_thread::sleep_for(kSample);
    }
    for (const pid_t left : processes_marked(mark)) kill(left, SIGKILL);  // of a test that has crashed
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Verdict::Passed;
    const long long waited_ms = waits.longest_ns() / 1'000'000;
    if (waits.longest_ns() < kMostWaiting_ns) {
      std::printf("%s failed in a fair trial: no thread waited for a processor for more than %lld ms of %lld\n",
                  test.c_str(), waited_ms, static_cast<long long>(kSample.count()));
      return Verdict::Failed;
    }
    std::printf(
        "%s: trial %d of %d is void: a thread waited for a processor for %lld ms between two looks, %lld ms apart or "
        "more\n",
        test.c_str(), i, kMostTrials, waited_ms, static_cast<long long>(kSample.count()));
    std::fflush(stdout);
  }
  return Verdict::None;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv, argv + argc);
  const bool lists = std::find(words.begin(), words.end(), "--gtest_list_tests") != words.end();
  if (lists || std::getenv(kTrial) != nullptr) {
    testing::InitGoogleMock(&argc, argv);
    return RUN_ALL_TESTS();
  }
  std::vector<std::string> failed, undecided;
  const std::vector<std::string> tests = chosen(words);
  for (const std::string& test : tests) {
    const Verdict verdict = try_fairly(words, test);
    if (verdict == Verdict::Failed) failed.push_back(test);
    if (verdict == Verdict::None) undecided.push_back(test);
  }
  std::printf("%zu tests, %zu failed, %zu without a verdict\n", tests.size(), failed.size(), undecided.size());
  for (const std::string& test : failed) std::printf("failed: %s\n", test.c_str());
  for (const std::string& test : undecided) std::printf("no verdict, the machine was too busy: %s\n", test.c_str());
  if (!failed.empty() || tests.empty()) return 1;
  return undecided.empty() ? 0 : kNoVerdict;
}
