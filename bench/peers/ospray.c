/* SPDX-License-Identifier: Apache-2.0
 * Renders spheres with OSPRay's path tracer through its C API, on one thread, under a white sky, and prints the seconds
 * of the frame. Settings are those of `ospray.py`: independent samples, no light sampling, no Russian roulette.
 *
 *   ospray SCENE OUT.ppm
 *
 * SCENE is text, all values separated by white space:
 *   width height samples depth
 *   origin (3) direction (3) up (3) vertical field of view in degrees, lens radius, focus distance
 *   number of materials, each: kind (0 lambertian, 1 metal, 2 glass) red green blue value (roughness or refractive index)
 *   number of spheres, radius of all or 0, file of floats, offset in bytes: x y z of all, without a common radius then
 *   all radii, then material indices as 32-bit integers
 */
#include <fcntl.h>
#include <ospray/ospray.h>
#include <ospray/ospray_util.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static void fail(const char *what) {
  fprintf(stderr, "ospray: error: %s\n", what);
  exit(1);
}

static void on_error(void *unused, OSPError code, const char *details) {
  (void)unused, (void)code;
  fail(details);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void read_numbers(FILE *in, int count, float *out) {
  for (int i = 0; i < count; ++i)
    if (fscanf(in, "%f", &out[i]) != 1) fail("the scene ends early");
}

static OSPMaterial material_from(FILE *in) {
  float v[5];
  read_numbers(in, 5, v);
  OSPMaterial m = ospNewMaterial(v[0] == 0 ? "obj" : v[0] == 1 ? "alloy" : "glass");
  if (v[0] == 2) {
    ospSetFloat(m, "eta", v[4]);
  } else {
    ospSetVec3f(m, v[0] == 0 ? "kd" : "color", v[1], v[2], v[3]);
    if (v[0] == 1) ospSetVec3f(m, "edgeColor", 1, 1, 1), ospSetFloat(m, "roughness", v[4]);
  }
  ospCommit(m);
  return m;
}

static OSPData shared(const void *numbers, OSPDataType type, uint64_t count) {
  OSPData data = ospNewSharedData1D(numbers, type, count);
  ospCommit(data);
  return data;
}

static OSPWorld world_from(FILE *in) {
  float count;
  read_numbers(in, 1, &count);
  OSPMaterial materials[4096];
  if (count < 1 || count > 4096) fail("the scene has more than 4096 materials");
  for (int i = 0; i < (int)count; ++i) materials[i] = material_from(in);

  unsigned long long spheres, offset;
  float radius;
  char name[4096];
  if (fscanf(in, "%llu %f %4095s %llu", &spheres, &radius, name, &offset) != 4) fail("no spheres");
  const int file = open(name, O_RDONLY);
  struct stat info;
  if (file < 0 || fstat(file, &info) != 0) fail("the file of the spheres cannot be opened");
  const char *bytes = mmap(NULL, (size_t)info.st_size, PROT_READ, MAP_PRIVATE, file, 0);
  const uint64_t each = radius > 0 ? 12 : 20;
  if (bytes == MAP_FAILED || (uint64_t)info.st_size < offset + each * spheres) fail("the file of the spheres is short");
  const float *centers = (const float *)(bytes + offset);

  OSPGeometry geometry = ospNewGeometry("sphere");
  ospSetObject(geometry, "sphere.position", shared(centers, OSP_VEC3F, spheres));
  if (radius > 0)
    ospSetFloat(geometry, "radius", radius);
  else
    ospSetObject(geometry, "sphere.radius", shared(centers + 3 * spheres, OSP_FLOAT, spheres));
  ospCommit(geometry);
  OSPGeometricModel model = ospNewGeometricModel(geometry);
  if (radius > 0) {
    ospSetObject(model, "material", materials[0]);
  } else {
    const uint32_t *index = (const uint32_t *)(centers + 4 * spheres);
    OSPMaterial *own = malloc(spheres * sizeof *own);
    for (uint64_t i = 0; i < spheres; ++i) own[i] = materials[index[i]];
    ospSetObject(model, "material", shared(own, OSP_MATERIAL, spheres));
  }
  ospCommit(model);
  OSPGroup group = ospNewGroup();
  ospSetObjectAsData(group, "geometry", OSP_GEOMETRIC_MODEL, model);
  ospCommit(group);
  OSPInstance instance = ospNewInstance(group);
  ospCommit(instance);
  OSPLight sky = ospNewLight("ambient");
  ospSetFloat(sky, "intensity", 1);
  ospCommit(sky);
  OSPWorld world = ospNewWorld();
  ospSetObjectAsData(world, "instance", OSP_INSTANCE, instance);
  ospSetObjectAsData(world, "light", OSP_LIGHT, sky);
  ospCommit(world);
  return world;
}

int main(int argc, char **argv) {
  if (argc != 3) fail("usage: ospray SCENE OUT.ppm");
  FILE *in = fopen(argv[1], "r");
  if (in == NULL) fail("the scene cannot be opened");
  if (ospInit(NULL, NULL) != OSP_NO_ERROR) fail("OSPRay does not start");
  OSPDevice device = ospNewDevice("cpu");
  const int threads = 1;
  ospDeviceSetParam(device, "numThreads", OSP_INT, &threads);
  ospDeviceSetErrorCallback(device, on_error, NULL);
  ospDeviceCommit(device);
  ospSetCurrentDevice(device);

  float image[4], view[12];
  read_numbers(in, 4, image);
  read_numbers(in, 12, view);
  const int width = (int)image[0], height = (int)image[1];
  OSPCamera camera = ospNewCamera("perspective");
  ospSetVec3f(camera, "position", view[0], view[1], view[2]);
  ospSetVec3f(camera, "direction", view[3], view[4], view[5]);
  ospSetVec3f(camera, "up", view[6], view[7], view[8]);
  ospSetFloat(camera, "fovy", view[9]);
  ospSetFloat(camera, "apertureRadius", view[10]);
  ospSetFloat(camera, "focusDistance", view[11]);
  ospSetFloat(camera, "aspect", image[0] / image[1]);
  ospCommit(camera);

  const double begin = now();
  OSPWorld world = world_from(in);
  const double built = now();
  OSPRenderer renderer = ospNewRenderer("pathtracer");
  ospSetInt(renderer, "maxPathLength", (int)image[3]);
  ospSetInt(renderer, "roulettePathLength", (int)image[3]);
  ospSetFloat(renderer, "minContribution", 0); /* its default ends paths of low throughput */
  ospSetInt(renderer, "lightSamples", 0);
  ospSetInt(renderer, "pixelSamples", 1);
  ospSetInt(renderer, "pixelFilter", OSP_PIXELFILTER_BOX);
  ospCommit(renderer);
  OSPFrameBuffer frame = ospNewFrameBuffer(width, height, OSP_FB_SRGBA, OSP_FB_COLOR | OSP_FB_ACCUM);
  ospRelease(ospRenderFrame(frame, renderer, camera, world)); /* what a first frame sets up does not count */
  ospResetAccumulation(frame);
  ospSetInt(renderer, "pixelSamples", (int)image[2]); /* one frame is faster than a frame a sample */
  ospCommit(renderer);
  const double start = now();
  OSPFuture done = ospRenderFrame(frame, renderer, camera, world);
  ospWait(done, OSP_TASK_FINISHED);
  printf("build %.6f\nseconds %.6f\n", built - begin, now() - start);
  ospRelease(done);

  const uint32_t *pixels = ospMapFrameBuffer(frame, OSP_FB_COLOR);
  FILE *out = fopen(argv[2], "wb");
  if (out == NULL) fail("the image cannot be written");
  fprintf(out, "P6 %d %d 255\n", width, height);
  for (int y = height; y-- > 0;)
    for (int x = 0; x < width; ++x) fwrite(&pixels[y * width + x], 1, 3, out);
  fclose(out);
  ospShutdown();
  return 0;
}
