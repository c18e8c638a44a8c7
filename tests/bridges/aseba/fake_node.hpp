// A module of a robot for tests: answers on a bus as the public sources say that nodes do. It shares nothing with the
// bridge: bytes are put together here by hand.
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bridges/can/can_link.hpp"
#include "tests/bridges/can/frames.hpp"

namespace tandem::bridges::aseba {

class FakeNode {
 public:
  using Bytes = std::vector<std::uint8_t>;

  FakeNode(std::unique_ptr<CanLink> bus, std::uint8_t node_id, std::string node_name,
           std::vector<std::pair<std::string, int>> named)
      : id(node_id), name(std::move(node_name)), variables(std::move(named)), bus_(std::move(bus)) {
    memory.resize(static_cast<std::size_t>(words()));
  }

  int words() const {
    int sum = 0;
    for (const auto& v : variables) sum += v.second;
    return sum;
  }

  /// Takes in what came and answers it.
  void work() {
    CanFrame frame;
    while (bus_->receive(frame)) {
      if (!on || frame.extended || frame.id >= 0x400 || (frame.id & 0xFFU) != 0) continue;
      const Bytes data(frame.data.begin(), frame.data.begin() + frame.size);
      const std::uint32_t kind = frame.id >> 8;
      if (kind == 1 || kind == 3) inner_.clear();
      inner_.insert(inner_.end(), data.begin(), data.end());
      if (kind >= 2) {
        answer(inner_);
        inner_.clear();
      }
    }
  }

  void say(std::uint16_t type, const Bytes& payload) {
    Bytes all = {static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(type >> 8)};
    all.insert(all.end(), payload.begin(), payload.end());
    for (std::size_t at = 0; at < all.size(); at += 8) {
      const bool first = at == 0;
      const bool last = at + 8 >= all.size();
      const std::uint32_t kind = first && last ? 3 : first ? 1 : last ? 2 : 0;
      const std::size_t n = std::min<std::size_t>(8, all.size() - at);
      bus_->send(make_frame(kind << 8 | id, std::span(all).subspan(at, n)));
    }
    ++said;
  }

  void describe() {
    ++described;
    Bytes d = text(name);
    for (const int word : {version, 1024, 32, memory_words < 0 ? words() : memory_words,
                           announced < 0 ? static_cast<int>(variables.size()) : announced, 1, 1}) {
      put(d, word);
    }
    say(0x9000, d);
    for (const auto& [variable, size] : variables) {
      Bytes v;
      put(v, size);
      append(v, text(variable));
      say(0x9001, v);
    }
    Bytes e = text("timer");
    append(e, text("every step"));
    say(0x9002, e);
    Bytes f = text("math.add");
    append(f, text("sum"));
    put(f, 2);
    put(f, -1);
    append(f, text("dest"));
    put(f, -1);
    append(f, text("src"));
    say(0x9003, f);
  }

  static void put(Bytes& bytes, int word) {
    bytes.push_back(static_cast<std::uint8_t>(word & 0xFF));
    bytes.push_back(static_cast<std::uint8_t>(word >> 8 & 0xFF));
  }
  static Bytes text(const std::string& s) {
    Bytes bytes;
    bytes.reserve(256);
    bytes.push_back(static_cast<std::uint8_t>(s.size()));
    for (const char c : s) bytes.push_back(static_cast<std::uint8_t>(c));
    return bytes;
  }
  static void append(Bytes& to, const Bytes& from) { to.insert(to.end(), from.begin(), from.end()); }

  std::uint8_t id;
  std::string name;
  std::vector<std::pair<std::string, int>> variables;
  std::vector<std::int16_t> memory;
  bool on = true;
  bool answers_reads = true;
  int version = 5;
  int memory_words = -1;  // announced; -1: the truth
  int announced = -1;     // number of variables; -1: the truth
  int reads = 0;
  int writes = 0;
  int described = 0;
  int said = 0;

 private:
  static int word(const Bytes& b, std::size_t i) { return b[2 * i] | b[2 * i + 1] << 8; }

  void answer(const Bytes& m) {
    if (m.size() < 4) return;
    const int type = word(m, 0);
    const int first = word(m, 1);
    if (type == 0xA011 && version >= 5) {
      Bytes p;
      put(p, version);
      say(0x900C, p);
    } else if (type == 0xA000 && first <= 4) {
      describe();
    } else if (type == 0xA010 && version >= 5 && first == id) {
      describe();
    } else if (type == 0xA00B && first == id && m.size() == 8) {
      ++reads;
      if (!answers_reads) return;
      Bytes p;
      put(p, word(m, 2));
      for (int i = 0; i < word(m, 3); ++i) {
        const auto at = static_cast<std::size_t>(word(m, 2) + i);
        put(p, at < memory.size() ? memory[at] : 0);
      }
      say(0x9005, p);
    } else if (type == 0xA00C && first == id) {
      ++writes;
      for (std::size_t i = 3; 2 * i + 1 < m.size(); ++i) {
        const std::size_t at = static_cast<std::size_t>(word(m, 2)) + i - 3;
        if (at < memory.size()) memory[at] = static_cast<std::int16_t>(word(m, i));
      }
    }
  }

  std::unique_ptr<CanLink> bus_;
  Bytes inner_;
};

}  // namespace tandem::bridges::aseba
