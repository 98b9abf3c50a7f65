#pragma once
#include "geometry_msgs/msg/transform.hpp"
