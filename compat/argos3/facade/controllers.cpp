#include "compat/argos3/facade/controllers.hpp"

#include <map>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

namespace tandem::compat::argos3 {
namespace {

struct Entry {
  std::shared_ptr<KeptController> kept;
  bool left = false;  // nothing steps it
};

struct Table {
  std::mutex mutex;
  std::map<std::string, Entry> by_robot;
  std::set<std::string> wanted;  // by robots that are made next
  bool held = false;
};
Table& table() {
  static Table* const all = new Table;  // outlives static objects of libraries
  return *all;
}

}  // namespace

void enter_controller(const std::string& robot, const std::shared_ptr<KeptController>& kept) {
  Entry before;
  {
    const std::lock_guard lock(table().mutex);
    before = std::exchange(table().by_robot[robot], Entry{kept});
  }
  if (before.left && before.kept != kept) before.kept->end();
}

std::shared_ptr<KeptController> kept_controller(const std::string& robot) {
  const std::lock_guard lock(table().mutex);
  const auto found = table().by_robot.find(robot);
  if (table().wanted.erase(robot) == 0 || found == table().by_robot.end()) return nullptr;
  return found->second.kept;
}

bool leave_controller(const std::string& robot, const KeptController& kept) {
  const std::lock_guard lock(table().mutex);
  const auto found = table().by_robot.find(robot);
  if (found == table().by_robot.end() || found->second.kept.get() != &kept) return false;
  if (!table().held)
    table().by_robot.erase(found);
  else
    found->second.left = true;
  return table().held;
}

bool controllers_are_held() {
  const std::lock_guard lock(table().mutex);
  return table().held;
}

void hold_controllers(bool on) {
  const std::lock_guard lock(table().mutex);
  table().held = on;
}

::argos::CCI_Controller* controller_of(const std::string& robot) {
  const std::lock_guard lock(table().mutex);
  const auto found = table().by_robot.find(robot);
  return found == table().by_robot.end() ? nullptr : &found->second.kept->controller();
}

void keep_controller(const std::string& robot) {
  const std::lock_guard lock(table().mutex);
  if (table().by_robot.contains(robot)) table().wanted.insert(robot);
}

void end_controller(const std::string& robot) {
  std::shared_ptr<KeptController> ended;
  {
    const std::lock_guard lock(table().mutex);
    const auto found = table().by_robot.find(robot);
    if (found == table().by_robot.end()) return;
    ended = std::move(found->second.kept);
    table().by_robot.erase(found);
  }
  ended->end();
}

void end_left_controllers() {
  std::vector<std::shared_ptr<KeptController>> ended;
  {
    const std::lock_guard lock(table().mutex);
    table().wanted.clear();
    for (auto it = table().by_robot.begin(); it != table().by_robot.end();) {
      if (it->second.left) {
        ended.push_back(std::move(it->second.kept));
        it = table().by_robot.erase(it);
      } else {
        ++it;
      }
    }
  }
  for (const auto& one : ended) one->end();
}

}  // namespace tandem::compat::argos3
