// A mesh under Embree's tree, asked about files of rays, an order a line of standard input: the other side of `ogee bench rays`, with the
// same orders and the same files. One thread, a ray at a time.
//
// usage: rays MESH.obj [robust] [CONFIG]      CONFIG goes to the device: hugepages=0
//
//   build                     the tree is made anew          answers its bytes, with its leaves and without the mesh's own arrays
//   closest FILE FIRST COUNT  what some rays meet first      answers `done`
//   together FILE FIRST COUNT the same, sixteen rays at once  answers `done`
//   any FILE FIRST COUNT      whether they meet anything     answers `done`
//   answers FILE OUT          triangles (u32), then distances (f32), of all rays of a file; `done`
//
// gcc -O2 -o rays rays.c -lembree3
#include <embree3/rtcore.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xmmintrin.h>

enum { MOST_SETS = 16, NONE = RTC_INVALID_GEOMETRY_ID };

typedef struct { float x, y, z, dx, dy, dz, t_max; } Ray;
typedef struct { char name[256]; size_t n; Ray *rays; unsigned *triangles; float *distances; } Set;

static struct { float *positions; unsigned *triangles; size_t n_positions, n_triangles; } mesh;
static Set sets[MOST_SETS];
static ssize_t bytes;
static RTCDevice device;
static RTCScene scene;
static struct RTCIntersectContext context, coherent;

static void fail(const char *why, const char *of) {
  fprintf(stderr, "%s: %s\n", of, why);
  exit(1);
}

static void *grown(void *array, size_t n, size_t size) {  // doubles whenever n reaches a power of two
  return n & (n - 1) ? array : realloc(array, (n ? 2 * n : 1) * size + 16);  // Embree may read 16 bytes beyond
}

static void read_mesh(const char *path) {
  FILE *file = fopen(path, "r");
  if (!file) fail("cannot be read", path);
  char line[512];
  while (fgets(line, sizeof line, file)) {
    char *at = line + 2;
    if (!strncmp(line, "v ", 2)) {
      mesh.positions = grown(mesh.positions, mesh.n_positions, 12);
      for (int i = 0; i < 3; i++) mesh.positions[3 * mesh.n_positions + i] = strtof(at, &at);
      mesh.n_positions++;
    } else if (!strncmp(line, "f ", 2)) {
      mesh.triangles = grown(mesh.triangles, mesh.n_triangles, 12);
      for (int i = 0; i < 3; i++) mesh.triangles[3 * mesh.n_triangles + i] = strtoul(at, &at, 10) - 1;
      mesh.n_triangles++;
    }
  }
  fclose(file);
}

static bool count_bytes(void *user, ssize_t change, bool post) {
  __sync_add_and_fetch(&bytes, change);
  return true;
}

static void build(int robust) {
  if (scene) rtcReleaseScene(scene);
  bytes = 0;
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions, 0, 12, mesh.n_positions);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles, 0, 12, mesh.n_triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
}

static Set *set_of(const char *name) {
  Set *set = sets;
  while (set < sets + MOST_SETS && set->n && strcmp(set->name, name)) set++;
  if (set == sets + MOST_SETS) fail("too many files of rays", name);
  if (set->n) return set;
  FILE *file = fopen(name, "rb");
  if (!file) fail("cannot be read", name);
  fseek(file, 0, SEEK_END);
  snprintf(set->name, sizeof set->name, "%s", name);
  set->n = ftell(file) / sizeof(Ray);
  set->rays = malloc(set->n * sizeof(Ray));
  set->triangles = malloc(set->n * 4);
  set->distances = malloc(set->n * 4);
  rewind(file);
  if (fread(set->rays, sizeof(Ray), set->n, file) != set->n) fail("ends early", name);
  fclose(file);
  return set;
}

static inline struct RTCRay ray_of(const Ray *r) {
  return (struct RTCRay){ .org_x = r->x, .org_y = r->y, .org_z = r->z, .dir_x = r->dx, .dir_y = r->dy, .dir_z = r->dz, .tfar = r->t_max, .mask = -1 };
}

static void closest(Set *set, size_t first, size_t end) {
  for (size_t i = first; i < end; i++) {
    struct RTCRayHit asked = { .ray = ray_of(set->rays + i), .hit = { .geomID = NONE, .primID = NONE } };
    rtcIntersect1(scene, &context, &asked);
    set->triangles[i] = asked.hit.primID;
    set->distances[i] = asked.hit.primID == NONE ? INFINITY : asked.ray.tfar;
  }
}

enum { AT_ONCE = 16 };

static void together(Set *set, size_t first, size_t end) {
  for (size_t from = first; from < end; from += AT_ONCE) {
    size_t n = end - from < AT_ONCE ? end - from : AT_ONCE;
    int valid[AT_ONCE] __attribute__((aligned(64)));
    struct RTCRayHit16 asked __attribute__((aligned(64)));
    for (size_t i = 0; i < AT_ONCE; i++) {
      const Ray *r = set->rays + from + (i < n ? i : 0);
      valid[i] = i < n ? -1 : 0;
      asked.ray.org_x[i] = r->x, asked.ray.org_y[i] = r->y, asked.ray.org_z[i] = r->z;
      asked.ray.dir_x[i] = r->dx, asked.ray.dir_y[i] = r->dy, asked.ray.dir_z[i] = r->dz;
      asked.ray.tnear[i] = 0, asked.ray.tfar[i] = r->t_max, asked.ray.mask[i] = -1;
      asked.ray.time[i] = 0, asked.ray.id[i] = 0, asked.ray.flags[i] = 0;
      asked.hit.geomID[i] = asked.hit.primID[i] = asked.hit.instID[0][i] = NONE;
    }
    rtcIntersect16(valid, scene, &coherent, &asked);
    for (size_t i = 0; i < n; i++) {
      set->triangles[from + i] = asked.hit.primID[i];
      set->distances[from + i] = asked.hit.primID[i] == NONE ? INFINITY : asked.ray.tfar[i];
    }
  }
}

static void any(Set *set, size_t first, size_t end) {
  for (size_t i = first; i < end; i++) {
    struct RTCRay asked = ray_of(set->rays + i);
    rtcOccluded1(scene, &context, &asked);
    set->triangles[i] = asked.tfar < 0 ? 0 : NONE;
    set->distances[i] = 0;
  }
}

static void write_answers(Set *set, const char *path) {
  FILE *file = fopen(path, "wb");
  if (!file || fwrite(set->triangles, 4, set->n, file) != set->n || fwrite(set->distances, 4, set->n, file) != set->n || fclose(file))
    fail("cannot be written", path);
}

int main(int n_words, char **words) {
  if (n_words < 2) fail("a mesh is wanted", words[0]);
  int robust = n_words > 2 && !strcmp(words[2], "robust");
  char config[256];
  snprintf(config, sizeof config, "threads=1,set_affinity=0%s%s", n_words > 2 + robust ? "," : "", n_words > 2 + robust ? words[2 + robust] : "");
  _mm_setcsr(_mm_getcsr() | 0x8040);  // floats near 0 are 0, as Embree recommends
  device = rtcNewDevice(config);
  if (!device) fail("makes no device", config);
  rtcSetDeviceMemoryMonitorFunction(device, count_bytes, NULL);
  rtcInitIntersectContext(&context);
  rtcInitIntersectContext(&coherent);
  coherent.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  read_mesh(words[1]);
  build(robust);
  char line[1024], order[16], file[256], out[256];
  while (fgets(line, sizeof line, stdin)) {
    size_t from, count;
    if (!strcmp(line, "build\n")) {
      build(robust);
      printf("%zd\n", bytes);
    } else if (sscanf(line, "answers %255s %255s", file, out) == 2) {
      write_answers(set_of(file), out);
      puts("done");
    } else if (sscanf(line, "%15s %255s %zu %zu", order, file, &from, &count) == 4) {
      Set *set = set_of(file);
      size_t end = from + count < set->n ? from + count : set->n;
      (!strcmp(order, "any") ? any : !strcmp(order, "together") ? together : closest)(set, from, end);
      puts("done");
    } else fail("is no order", line);
    fflush(stdout);
  }
}
