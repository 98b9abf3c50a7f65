// Answers questions about transforms with tf2's own core: one command a line, one answer a line.
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include "rcutils/logging_macros.h"
#include "tf2/buffer_core.h"
#include "tf2/exceptions.h"

using std::string;

static string one_line(const string & text) {
  string out;
  for (char c : text) {
    if (c == '\n') {out += "\\n";} else if (c == '\\') {out += "\\\\";} else {out += c;}
  }
  return out;
}

static string word(std::istream & in) {
  string text;
  in >> text;
  return text == "-" ? "" : text;  // an empty name
}

static tf2::TimePoint time_of(std::istream & in) {
  long long ns;
  in >> ns;
  return tf2::TimePoint(std::chrono::nanoseconds(ns));
}

static void print(const geometry_msgs::msg::TransformStamped & msg) {
  const auto & t = msg.transform;
  std::cout << "ok " << t.translation.x << ' ' << t.translation.y << ' ' << t.translation.z << ' '
            << t.rotation.x << ' ' << t.rotation.y << ' ' << t.rotation.z << ' ' << t.rotation.w
            << ' ' << (msg.header.stamp.sec * 1000000000ll + msg.header.stamp.nanosec) << '\n';
}

static void answer(tf2::BufferCore & core, const string & command, std::istream & in) {
  if (command == "set") {
    bool is_static;
    geometry_msgs::msg::TransformStamped msg;
    string authority;
    in >> is_static;
    msg.header.frame_id = word(in);
    msg.child_frame_id = word(in);
    in >> msg.header.stamp.sec >> msg.header.stamp.nanosec;
    auto & t = msg.transform;
    in >> t.translation.x >> t.translation.y >> t.translation.z;
    in >> t.rotation.x >> t.rotation.y >> t.rotation.z >> t.rotation.w >> authority;
    bool taken = core.setTransform(msg, authority, is_static);
    std::cout << "set " << taken << ' ' << one_line(logged()) << '\n';
    logged().clear();
  } else if (command == "lookup") {
    string target = word(in), source = word(in);
    print(core.lookupTransform(target, source, time_of(in)));
  } else if (command == "full") {
    string target = word(in);
    auto target_time = time_of(in);
    string source = word(in);
    auto source_time = time_of(in);
    print(core.lookupTransform(target, target_time, source, source_time, word(in)));
  } else if (command == "can") {
    string target = word(in), source = word(in), text;
    bool can = core.canTransform(target, source, time_of(in), &text);
    std::cout << "can " << can << ' ' << one_line(text) << '\n';
  } else if (command == "velocity") {
    string tracking = word(in), observation = word(in), reference = word(in);
    double x, y, z;
    in >> x >> y >> z;
    string frame = word(in);
    auto time = time_of(in);
    long long interval;
    in >> interval;
    auto v = core.lookupVelocity(
      tracking, observation, reference, tf2::Vector3(x, y, z), frame, time,
      tf2::Duration(std::chrono::nanoseconds(interval))).velocity;
    std::cout << "velocity " << v.linear.x << ' ' << v.linear.y << ' ' << v.linear.z << ' '
              << v.angular.x << ' ' << v.angular.y << ' ' << v.angular.z << '\n';
  } else if (command == "latest") {
    string target = word(in), source = word(in), text;
    auto to = core._validateFrameId("get_latest_common_time", target);
    auto from = core._validateFrameId("get_latest_common_time", source);
    tf2::TimePoint time;
    if (core._getLatestCommonTime(to, from, time, &text) != tf2::TF2Error::TF2_NO_ERROR) {
      throw tf2::TransformException(text);
    }
    std::cout << "latest " << time.time_since_epoch().count() << '\n';
  } else if (command == "chain") {
    string target = word(in);
    auto target_time = time_of(in);
    string source = word(in);
    auto source_time = time_of(in);
    std::vector<string> found;
    core._chainAsVector(target, target_time, source, source_time, word(in), found);
    std::cout << "chain";
    for (auto & one : found) {std::cout << ' ' << one;}
    std::cout << '\n';
  } else if (command == "yaml") {
    std::cout << "text " << one_line(core.allFramesAsYAML()) << '\n';
  } else if (command == "string") {
    std::cout << "text " << one_line(core.allFramesAsString()) << '\n';
  } else if (command == "dot") {
    std::cout << "text " << one_line(core._allFramesAsDot(time_of(in))) << '\n';
  } else if (command == "clear") {
    core.clear();
    std::cout << "cleared\n";
  }
}

int main() {
  auto core = std::make_unique<tf2::BufferCore>();
  string line;
  std::cout << std::setprecision(17);
  while (std::getline(std::cin, line)) {
    std::istringstream in(line);
    string command;
    in >> command;
    if (command == "new") {
      core = std::make_unique<tf2::BufferCore>();
      std::cout << "new\n";
      continue;
    }
    try {
      answer(*core, command, in);
    } catch (const tf2::ConnectivityException & e) {
      std::cout << "error ConnectivityException " << one_line(e.what()) << '\n';
    } catch (const tf2::LookupException & e) {
      std::cout << "error LookupException " << one_line(e.what()) << '\n';
    } catch (const tf2::BackwardExtrapolationException & e) {
      std::cout << "error BackwardExtrapolationException " << one_line(e.what()) << '\n';
    } catch (const tf2::ForwardExtrapolationException & e) {
      std::cout << "error ForwardExtrapolationException " << one_line(e.what()) << '\n';
    } catch (const tf2::NoDataForExtrapolationException & e) {
      std::cout << "error NoDataForExtrapolationException " << one_line(e.what()) << '\n';
    } catch (const tf2::InvalidArgumentException & e) {
      std::cout << "error InvalidArgumentException " << one_line(e.what()) << '\n';
    } catch (const tf2::TransformException & e) {
      std::cout << "error TransformException " << one_line(e.what()) << '\n';
    }
  }
}
