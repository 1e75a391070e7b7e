// SPDX-License-Identifier: MIT
// Embree 3 and 4 by one set of names. CMake says which one it found. Only ray_tracer.cpp includes
// it.
#pragma once

#if RAYMOVAL_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace raymoval::simulated {

#if RAYMOVAL_EMBREE >= 4
using TraceOptions = RTCIntersectArguments;
#else
using TraceOptions = RTCIntersectContext;
#endif

/// @return what Embree is told with each packet of rays that start close to each other
inline TraceOptions coherent_rays() {
  TraceOptions options;
#if RAYMOVAL_EMBREE >= 4
  rtcInitIntersectArguments(&options);
  options.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
  rtcInitIntersectContext(&options);
  options.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  return options;
}

/// Finds what eight rays hit first.
/// @param valid -1 for each ray that counts, else 0
inline void trace_eight(const int* valid, RTCScene scene, TraceOptions& options,
                        RTCRayHit8& packet) {
#if RAYMOVAL_EMBREE >= 4
  rtcIntersect8(valid, scene, &packet, &options);
#else
  rtcIntersect8(valid, scene, &options, &packet);
#endif
}

}  // namespace raymoval::simulated
