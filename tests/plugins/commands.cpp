// Commands: one that works, and some that go wrong in their ways.
#include <cstdio>
#include <stdexcept>

#include "hal/command.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

struct Sum {
  std::vector<std::int64_t> numbers;
  std::optional<double> times;
  std::string how = "plain";

  void describe(hal::CommandLine& line) {
    line.word("number", numbers, "Numbers").required();
    line.option("--times", times, "Multiplies the sum").range(0.5, 2.0);
    line.option("--how", how, "How it is written").show_default().one_of({"plain", "loud"}).needs("--times");
  }
};

[[maybe_unused]] hal::Result<int> sum(const Sum& values) {
  double all = 0.0;
  for (const std::int64_t number : values.numbers) all += static_cast<double>(number);
  std::printf("%g%s\n", all * values.times.value_or(1.0), values.how == "loud" ? "!" : "");
  return 0;
}

struct Nothing {
  void describe(hal::CommandLine& /*unused*/) {}
};

[[maybe_unused]] hal::Result<int> throws(const Nothing& /*unused*/) {
  throw std::runtime_error("it broke");
}
[[maybe_unused]] hal::Result<int> fails(const Nothing& /*unused*/) {
  return hal::Error{"no paper"};
}
[[maybe_unused]] hal::Result<int> ends_oddly(const Nothing& /*unused*/) {
  return 77;
}

struct TwiceDescribed {
  bool once = false;
  void describe(hal::CommandLine& line) {
    line.flag("--once", once, "This");
    line.flag("--once", once, "That");
  }
};

[[maybe_unused]] hal::Result<int> nothing(const TwiceDescribed& /*unused*/) {
  return 0;
}

void register_all(hal::Registrar& registrar) {
#ifdef TANDEM_TEST_SECOND
  static const hal::CommandType known = hal::command_type<Nothing, fails>("run", "The program has one of this name.");
  registrar.add(known);
#else
  static const hal::CommandType good = hal::command_type<Sum, sum>("test_sum", "Add numbers.");
  static const hal::CommandType thrown = hal::command_type<Nothing, throws>("test_throws", "Throw.");
  static const hal::CommandType failed = hal::command_type<Nothing, fails>("test_fails", "Fail.");
  static const hal::CommandType odd = hal::command_type<Nothing, ends_oddly>("test_odd", "End oddly.");
  for (const auto* type : {&good, &thrown, &failed, &odd}) registrar.add(*type);
#ifdef TANDEM_TEST_FAULTY
  static const hal::CommandType twice = hal::command_type<TwiceDescribed, nothing>("test_twice", "");
  registrar.add(twice);
#endif
#endif
}

}  // namespace

TANDEM_PLUGIN(register_all)
