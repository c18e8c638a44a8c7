#include "study/sweep/message.hpp"

#include <cstring>
#include <type_traits>

#include "hal/check.hpp"

namespace tandem::study {
namespace {

// Both ends are one program on one machine: numbers go as they lie in memory.
class Writer {
 public:
  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void word(const std::string& value) {
    number(static_cast<std::uint64_t>(value.size()));
    text += value;
  }
  template <class T>
  void numbers(const std::vector<T>& values) {
    number(static_cast<std::uint64_t>(values.size()));
    if (!values.empty()) text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  std::string text;
};

class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}
  template <class T>
  T number() {
    T value{};
    copy(&value, sizeof value);
    return value;
  }
  std::string word() {
    std::string value(static_cast<std::size_t>(number<std::uint64_t>()), '\0');
    copy(value.data(), value.size());
    return value;
  }
  template <class T>
  std::vector<T> numbers() {
    std::vector<T> values(static_cast<std::size_t>(number<std::uint64_t>()));
    copy(values.data(), values.size() * sizeof(T));
    return values;
  }

 private:
  void copy(void* to, std::size_t bytes) {
    TANDEM_CHECK(bytes <= text_.size() - at_, "a worker's message is whole");
    if (bytes > 0) std::memcpy(to, text_.data() + at_, bytes);
    at_ += bytes;
  }
  const std::string& text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string message_of(std::int64_t run, const RunOutcome& o) {
  Writer w;
  w.number(std::uint64_t{0});  // its size
  w.number(run);
  w.number(o.done);
  w.word(o.ended);
  w.word(o.failure);
  w.number(o.ticks);
  w.number(o.virtual_s);
  w.number(o.fingerprint);
  w.number(o.wall_s);
  w.number(o.cpu_s);
  w.number(static_cast<std::uint64_t>(o.measures.size()));
  for (const auto& [name, value] : o.measures) {
    w.word(name);
    w.number(value);
  }
  w.numbers(o.sample_ticks);
  w.number(static_cast<std::uint64_t>(o.samples.size()));
  for (const auto& [name, values] : o.samples) {
    w.word(name);
    w.numbers(values);
  }
  const auto size = static_cast<std::uint64_t>(w.text.size());
  std::memcpy(w.text.data(), &size, sizeof size);
  return std::move(w.text);
}

std::optional<ToldOutcome> take_message(std::string& received) {
  std::uint64_t size = 0;
  if (received.size() < sizeof size) return std::nullopt;
  std::memcpy(&size, received.data(), sizeof size);
  if (received.size() < size) return std::nullopt;
  const std::string text = received.substr(sizeof size, size - sizeof size);
  received.erase(0, size);
  Reader r(text);
  ToldOutcome told;
  RunOutcome& o = told.outcome;
  told.run = r.number<std::int64_t>();
  o.done = r.number<bool>();
  o.ended = r.word();
  o.failure = r.word();
  o.ticks = r.number<std::int64_t>();
  o.virtual_s = r.number<double>();
  o.fingerprint = r.number<std::uint64_t>();
  o.wall_s = r.number<double>();
  o.cpu_s = r.number<double>();
  for (auto left = r.number<std::uint64_t>(); left > 0; --left) {
    std::string name = r.word();
    o.measures.emplace_back(std::move(name), r.number<double>());
  }
  o.sample_ticks = r.numbers<std::int64_t>();
  for (auto left = r.number<std::uint64_t>(); left > 0; --left) {
    std::string name = r.word();
    o.samples.emplace_back(std::move(name), r.numbers<double>());
  }
  return told;
}

}  // namespace tandem::study
