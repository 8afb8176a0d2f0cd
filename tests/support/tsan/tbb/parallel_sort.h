#pragma once
#include "../tbb_for_tsan.h"
