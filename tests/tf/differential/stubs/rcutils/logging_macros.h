// What is logged goes to one string, which the oracle prints.
#pragma once
#include <cstdio>
#include <string>
inline std::string & logged() { static std::string text; return text; }
template<typename... A> void log_line(const char * format, A... args) {
  char line[4096];
  snprintf(line, sizeof line, format, args...);
  logged() += line;
  logged() += '\n';
}
#define RCUTILS_LOG_ERROR(...) log_line(__VA_ARGS__)
#define RCUTILS_LOG_WARN(...) log_line(__VA_ARGS__)
#define RCUTILS_LOG_WARN_THROTTLE(clock, interval, ...) log_line(__VA_ARGS__)
