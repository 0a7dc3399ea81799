/* Linear blend skinning as a game engine does it on the processor, to compare an apply with: four bones a vertex, one
   matrix a bone. `cc -O3 skinning.c -lm -o skinning && ./skinning VERTICES` prints the least of many runs, in milliseconds:
   positions, and positions with normals and tangents. */

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { BONES = 55, RUNS = 60 };

typedef struct { float x, y, z; } Vec3;
typedef struct { float x, y, z, w; } Vec4;
typedef struct { float m[12]; } Matrix; /* three rows of four */
typedef struct { uint8_t bone[4]; float weight[4]; } Row;

static Matrix blend(const Matrix *bones, const Row *row) {
    Matrix sum;
    for (int i = 0; i < 12; i++) {
        sum.m[i] = row->weight[0] * bones[row->bone[0]].m[i] + row->weight[1] * bones[row->bone[1]].m[i]
                 + row->weight[2] * bones[row->bone[2]].m[i] + row->weight[3] * bones[row->bone[3]].m[i];
    }
    return sum;
}

static Vec3 turn(const Matrix *m, float x, float y, float z) {
    return (Vec3){ m->m[0] * x + m->m[1] * y + m->m[2] * z, m->m[4] * x + m->m[5] * y + m->m[6] * z,
                   m->m[8] * x + m->m[9] * y + m->m[10] * z };
}

static Vec3 unit(Vec3 v) {
    float length = sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
    return length > 0 ? (Vec3){ v.x / length, v.y / length, v.z / length } : v;
}

static void positions(int count, const Matrix *bones, const Row *rows, const Vec3 *from, Vec3 *to) {
    for (int i = 0; i < count; i++) {
        Matrix m = blend(bones, &rows[i]);
        Vec3 p = turn(&m, from[i].x, from[i].y, from[i].z);
        to[i] = (Vec3){ p.x + m.m[3], p.y + m.m[7], p.z + m.m[11] };
    }
}

static void everything(int count, const Matrix *bones, const Row *rows, const Vec3 *from, Vec3 *to,
                       const Vec3 *normal, Vec3 *new_normal, const Vec4 *tangent, Vec4 *new_tangent) {
    for (int i = 0; i < count; i++) {
        Matrix m = blend(bones, &rows[i]);
        Vec3 p = turn(&m, from[i].x, from[i].y, from[i].z);
        to[i] = (Vec3){ p.x + m.m[3], p.y + m.m[7], p.z + m.m[11] };
        new_normal[i] = unit(turn(&m, normal[i].x, normal[i].y, normal[i].z));
        Vec3 t = unit(turn(&m, tangent[i].x, tangent[i].y, tangent[i].z));
        new_tangent[i] = (Vec4){ t.x, t.y, t.z, tangent[i].w };
    }
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec * 1e3 + t.tv_nsec * 1e-6;
}

static float random_share(void) { return (float)rand() / RAND_MAX; }

int main(int argument_count, char **arguments) {
    int count = argument_count > 1 ? atoi(arguments[1]) : 50000;
    Matrix bones[BONES];
    for (int b = 0; b < BONES; b++)
        for (int i = 0; i < 12; i++) bones[b].m[i] = (i % 5 == 0) + 0.1f * random_share();
    Row *rows = malloc(count * sizeof *rows);
    Vec3 *from = malloc(count * sizeof *from), *to = calloc(count, sizeof *to);
    Vec3 *normal = malloc(count * sizeof *normal), *new_normal = calloc(count, sizeof *new_normal);
    Vec4 *tangent = malloc(count * sizeof *tangent), *new_tangent = calloc(count, sizeof *new_tangent);
    for (int i = 0; i < count; i++) {
        /* Neighbours hang on the same bones, as in a model. */
        int bone = (int)((long)i * BONES / count);
        for (int k = 0; k < 4; k++) {
            rows[i].bone[k] = (uint8_t)((bone + k) % BONES);
            rows[i].weight[k] = 0.25f;
        }
        from[i] = (Vec3){ random_share(), random_share(), random_share() };
        normal[i] = unit((Vec3){ random_share(), random_share(), random_share() });
        tangent[i] = (Vec4){ normal[i].y, normal[i].z, normal[i].x, 1 };
    }
    double least[2] = { 1e9, 1e9 };
    for (int run = 0; run < RUNS; run++) {
        double start = now();
        positions(count, bones, rows, from, to);
        double middle = now();
        everything(count, bones, rows, from, to, normal, new_normal, tangent, new_tangent);
        double end = now();
        if (middle - start < least[0]) least[0] = middle - start;
        if (end - middle < least[1]) least[1] = end - middle;
    }
    printf("%.3f %.3f\n", least[0], least[1]);
    return to[count / 2].x + new_normal[count / 2].x + new_tangent[count / 2].x > 1e9f;
}
