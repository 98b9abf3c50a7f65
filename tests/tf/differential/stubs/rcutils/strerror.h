#pragma once
#include <cstddef>
inline void rcutils_strerror(char *, size_t) {}
