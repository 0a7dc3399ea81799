// Times Embree on the rays that the example `rays` wrote: embree FOLDER. One thread; all hits of each ray, in order of the
// distance, by asking for the next one beyond the last; prints milliseconds to build, milliseconds for all, and the hits.
#include <embree3/rtcore.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * t.tv_sec + 1e-6 * t.tv_nsec;
}

static void *read_all(const char *folder, const char *name, size_t item, size_t *count) {
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "rb");
  if (!file) exit(1);
  fseek(file, 0, SEEK_END);
  *count = (size_t)ftell(file) / item;
  rewind(file);
  void *data = malloc(*count * item + 16);
  if (fread(data, item, *count, file) != *count) exit(1);
  fclose(file);
  return data;
}

int main(int argc, char **argv) {
  if (argc < 2) return 1;
  size_t vertices, triangles, rays;
  float *positions = read_all(argv[1], "positions", 12, &vertices);
  unsigned *corners = read_all(argv[1], "triangles", 12, &triangles);
  float *lines = read_all(argv[1], "rays", 24, &rays);
  RTCDevice device = rtcNewDevice("threads=1");
  double least_build = INFINITY, least = INFINITY, least_first = INFINITY;
  size_t found = 0, found_first = 0;
  for (int run = 0; run < 5; ++run) {
    double start = now();
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions, 0, 12, vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners, 0, 12, triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
    least_build = fmin(least_build, now() - start);
    struct RTCIntersectContext context;
    for (int every = 0; every < 2; ++every) {
      size_t hits = 0;
      start = now();
      for (size_t index = 0; index < rays; ++index) {
        const float *line = lines + 6 * index;
        float from = 0;
        for (;;) {
          struct RTCRayHit hit = {{line[0], line[1], line[2], from, line[3], line[4], line[5], 0, INFINITY, ~0u, 0, 0}, {0}};
          hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
          rtcInitIntersectContext(&context);
          rtcIntersect1(scene, &context, &hit);
          if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
          ++hits;
          if (!every) break;
          from = nextafterf(hit.ray.tfar, INFINITY) * (1 + 1e-6f);
        }
      }
      if (every) {
        least = fmin(least, now() - start);
        found = hits;
      } else {
        least_first = fmin(least_first, now() - start);
        found_first = hits;
      }
    }
    rtcReleaseGeometry(geometry);
    rtcReleaseScene(scene);
  }
  printf("%f %f %zu %f %zu\n", least_build, least_first, found_first, least, found);
  return 0;
}
