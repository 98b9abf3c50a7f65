#pragma once
#include <cstdio>
#define rcutils_snprintf snprintf
