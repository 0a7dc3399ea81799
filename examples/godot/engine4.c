// Stands in for Godot 4 where there is none: gives superdeform_godot4.c the functions that it asks for, as strict as
// their documentation, and plays a script that uses the class by pointers and by variants.
//
//     engine4 FIGURE.obj OUT
//
// OUT gets the vertices of the last step, three 32-bit floats each. What the extension leaves behind is told.
#include <gdextension_interface.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition) \
  do { \
    if (!(condition)) printf("engine4.c:%d: %s\n", __LINE__, #condition), exit(1); \
  } while (0)

GDExtensionBool superdeform_godot_init(GDExtensionInterfaceGetProcAddress, GDExtensionClassLibraryPtr,
                                       GDExtensionInitialization *);

// ---- values: an engine's own are opaque, too. Each one that owns something is counted.

typedef struct { char *text; } Text;
typedef struct { void *data; GDExtensionInt count; } Packed;
typedef union { double number; GDExtensionInt integer; Text text; Packed packed; } Value;
typedef struct { GDExtensionVariantType type; Value value; } Variant;
#define FLOAT GDEXTENSION_VARIANT_TYPE_FLOAT
#define INT GDEXTENSION_VARIANT_TYPE_INT
#define STRING GDEXTENSION_VARIANT_TYPE_STRING
#define NAME GDEXTENSION_VARIANT_TYPE_STRING_NAME
#define INTS GDEXTENSION_VARIANT_TYPE_PACKED_INT32_ARRAY
#define VECTORS GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR3_ARRAY
static int alive;

static size_t element(GDExtensionVariantType type) { return type == INTS ? 4 : 12; }

static void new_text(void *to, const char *text) {
  ((Text *)to)->text = strcpy(malloc(strlen(text) + 1), text);
  alive++;
}
static void new_name(GDExtensionUninitializedStringNamePtr to, const char *text, GDExtensionBool is_static) {
  CHECK(!is_static);
  new_text(to, text);
}
static GDExtensionInt to_utf8(GDExtensionConstStringPtr from, char *to, GDExtensionInt most) {
  const char *text = ((const Text *)from)->text;
  const size_t length = strlen(text);
  if (to) memcpy(to, text, (GDExtensionInt)length < most ? length : (size_t)most);
  return (GDExtensionInt)length;
}

static void resize(GDExtensionVariantType type, Packed *packed, GDExtensionInt count) {
  packed->data = realloc(packed->data, (size_t)count * element(type) + 1);
  packed->count = count;
}
static void make_text(GDExtensionUninitializedTypePtr to, const GDExtensionConstTypePtr *arguments) {
  (void)arguments;
  new_text(to, "");
}
static void make_packed(GDExtensionUninitializedTypePtr to, const GDExtensionConstTypePtr *arguments) {
  (void)arguments;
  *(Packed *)to = (Packed){NULL, 0};
  alive++;
}
static GDExtensionPtrConstructor constructor_of(GDExtensionVariantType type, int32_t which) {
  CHECK(which == 0);
  return type == STRING ? make_text : make_packed;
}
static void destroy_text(GDExtensionTypePtr of) {
  CHECK(((Text *)of)->text);
  free(((Text *)of)->text);
  ((Text *)of)->text = NULL;
  alive--;
}
static void destroy_packed(GDExtensionTypePtr of) {
  free(((Packed *)of)->data);
  alive--;
}
static GDExtensionPtrDestructor destructor_of(GDExtensionVariantType type) {
  CHECK(type == STRING || type == NAME || type == INTS || type == VECTORS);
  return type == STRING || type == NAME ? destroy_text : destroy_packed;
}
static void size_of(GDExtensionTypePtr of, const GDExtensionConstTypePtr *arguments, GDExtensionTypePtr result, int count) {
  (void)arguments;
  CHECK(count == 0);
  *(GDExtensionInt *)result = ((Packed *)of)->count;
}
static void resize_vectors(GDExtensionTypePtr of, const GDExtensionConstTypePtr *arguments, GDExtensionTypePtr result,
                           int count) {
  CHECK(count == 1);
  resize(VECTORS, (Packed *)of, *(const GDExtensionInt *)arguments[0]);
  *(GDExtensionInt *)result = 0;
}
// The numbers are of extension_api.json.
static GDExtensionPtrBuiltInMethod method_of(GDExtensionVariantType type, GDExtensionConstStringNamePtr name,
                                             GDExtensionInt hash) {
  const char *text = ((const Text *)name)->text;
  CHECK(type == INTS || type == VECTORS);
  if (strcmp(text, "size") == 0 && hash == 3173160232) return size_of;
  CHECK(type == VECTORS && strcmp(text, "resize") == 0 && hash == 848867239);
  return resize_vectors;
}
static GDExtensionTypePtr vector_at(GDExtensionTypePtr of, GDExtensionInt i) {
  CHECK(i >= 0 && i < ((Packed *)of)->count);
  return (float *)((Packed *)of)->data + 3 * i;
}
static GDExtensionTypePtr vector_of(GDExtensionConstTypePtr of, GDExtensionInt i) {
  return vector_at((GDExtensionTypePtr)of, i);
}
static const int32_t *int_of(GDExtensionConstTypePtr of, GDExtensionInt i) {
  CHECK(i >= 0 && i < ((const Packed *)of)->count);
  return (const int32_t *)((const Packed *)of)->data + i;
}

static Value copy(GDExtensionVariantType type, const Value *from) {
  Value made = *from;
  if (type == STRING) new_text(&made, from->text.text);
  if (type == INTS || type == VECTORS) {
    make_packed(&made, NULL);
    resize(type, &made.packed, from->packed.count);
    if (from->packed.count) memcpy(made.packed.data, from->packed.data, (size_t)from->packed.count * element(type));
  }
  return made;
}
static GDExtensionVariantType wanted;
static void variant_from(GDExtensionUninitializedVariantPtr to, GDExtensionTypePtr from) {
  *(Variant *)to = (Variant){wanted, copy(wanted, (const Value *)from)};
}
// A pool of memory has the size of its type: nothing is written beyond it.
static void type_from(GDExtensionUninitializedTypePtr to, GDExtensionVariantPtr from) {
  const Variant *variant = (const Variant *)from;
  const Value made = copy(variant->type, &variant->value);
  CHECK(variant->type == wanted || (wanted == FLOAT && variant->type == INT));
  if (variant->type == INT) *(double *)to = (double)made.integer;
  else memcpy(to, &made, wanted == FLOAT || wanted == STRING ? 8 : 16);
}
static GDExtensionVariantFromTypeConstructorFunc to_variant(GDExtensionVariantType type) {
  wanted = type;
  return variant_from;
}
static GDExtensionTypeFromVariantConstructorFunc from_variant(GDExtensionVariantType type) {
  wanted = type;
  return type_from;
}
static GDExtensionVariantType type_of(GDExtensionConstVariantPtr of) { return ((const Variant *)of)->type; }

// ---- classes: one, with a few methods.

static GDExtensionClassCreationInfo2 registered;
// What a description points to is there during the call alone.
static struct { char name[16]; GDExtensionClassMethodInfo info; } methods[8];
static int method_count, objects;
static GDExtensionClassInstancePtr instance;

static void register_class(GDExtensionClassLibraryPtr library, GDExtensionConstStringNamePtr name,
                           GDExtensionConstStringNamePtr parent, const GDExtensionClassCreationInfo2 *info) {
  CHECK(library && strcmp(((const Text *)name)->text, "SuperDeform") == 0);
  CHECK(strcmp(((const Text *)parent)->text, "RefCounted") == 0 && info->is_exposed && !info->is_abstract);
  registered = *info;
}
static void register_method(GDExtensionClassLibraryPtr library, GDExtensionConstStringNamePtr name,
                            const GDExtensionClassMethodInfo *info) {
  CHECK(library && registered.create_instance_func && strcmp(((const Text *)name)->text, "SuperDeform") == 0);
  const GDExtensionPropertyInfo *result = info->return_value_info;
  CHECK(info->has_return_value && result->hint_string && result->class_name);
  CHECK(result->type == (info->argument_count ? STRING : VECTORS));
  for (uint32_t i = 0; i < info->argument_count; i++) {
    CHECK(((Text *)info->arguments_info[i].name)->text[0] && info->arguments_info[i].hint_string);
    CHECK(info->arguments_info[i].class_name && info->arguments_metadata[i] == 0);
  }
  CHECK(method_count < 8);
  strcpy(methods[method_count].name, ((Text *)info->name)->text);
  methods[method_count].info = *info;
  methods[method_count].info.return_value_info = methods[method_count].info.arguments_info = NULL;
  method_count++;
}
static void unregister_class(GDExtensionClassLibraryPtr library, GDExtensionConstStringNamePtr name) {
  CHECK(library && strcmp(((const Text *)name)->text, "SuperDeform") == 0);
  method_count = 0;
}
static GDExtensionObjectPtr construct(GDExtensionConstStringNamePtr name) {
  CHECK(strcmp(((const Text *)name)->text, "RefCounted") == 0);
  objects++;
  return &objects;
}
static void set_instance(GDExtensionObjectPtr object, GDExtensionConstStringNamePtr name, GDExtensionClassInstancePtr of) {
  CHECK(object == &objects && of && strcmp(((const Text *)name)->text, "SuperDeform") == 0);
  instance = of;
}

#define FUNCTION(name, of) {name, (GDExtensionInterfaceFunctionPtr)(void (*)(void))(of)}
static GDExtensionInterfaceFunctionPtr get(const char *name) {
  static const struct { const char *name; GDExtensionInterfaceFunctionPtr of; } functions[] = {
      FUNCTION("string_new_with_utf8_chars", new_text), FUNCTION("string_to_utf8_chars", to_utf8),
      FUNCTION("string_name_new_with_latin1_chars", new_name), FUNCTION("packed_vector3_array_operator_index", vector_at),
      FUNCTION("packed_vector3_array_operator_index_const", vector_of),
      FUNCTION("packed_int32_array_operator_index_const", int_of), FUNCTION("variant_get_ptr_constructor", constructor_of),
      FUNCTION("variant_get_ptr_destructor", destructor_of), FUNCTION("variant_get_ptr_builtin_method", method_of),
      FUNCTION("get_variant_from_type_constructor", to_variant),
      FUNCTION("get_variant_to_type_constructor", from_variant), FUNCTION("variant_get_type", type_of),
      FUNCTION("classdb_register_extension_class2", register_class),
      FUNCTION("classdb_register_extension_class_method", register_method),
      FUNCTION("classdb_unregister_extension_class", unregister_class),
      FUNCTION("classdb_construct_object", construct), FUNCTION("object_set_instance", set_instance)};
  for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
    if (strcmp(name, functions[i].name) == 0) return functions[i].of;
  return NULL;
}

// ---- the script

static const GDExtensionClassMethodInfo *method(const char *name) {
  for (int i = 0; i < method_count; i++)
    if (strcmp(methods[i].name, name) == 0) return &methods[i].info;
  CHECK(!"the class has the method");
  return NULL;
}
// By variants, as where a script does not know types. What comes back is the caller's.
static Variant call(const char *name, const Variant *arguments, int count, GDExtensionCallError *error) {
  const GDExtensionClassMethodInfo *info = method(name);
  GDExtensionConstVariantPtr pointers[8];
  Variant result = {GDEXTENSION_VARIANT_TYPE_NIL, {0}};
  for (int i = 0; i < count; i++) pointers[i] = &arguments[i];
  info->call_func(info->method_userdata, instance, pointers, count, &result, error);
  return result;
}
// What a call that gives a sentence says; the sentence is taken away.
static const char *said(Variant variant) {
  static char sentence[1024];
  CHECK(variant.type == STRING);
  snprintf(sentence, sizeof sentence, "%s", variant.value.text.text);
  destroy_text(&variant.value);
  return sentence;
}
// By pointers, as where it does.
static Packed vectors(const char *name) {
  Packed result;
  make_packed(&result, NULL);
  const GDExtensionClassMethodInfo *info = method(name);
  CHECK(info->argument_count == 0);
  info->ptrcall_func(info->method_userdata, instance, NULL, &result);
  return result;
}

static double height(const Packed *of) {
  float least = 1e30f, most = -1e30f;
  for (GDExtensionInt i = 0; i < of->count; i++) {
    const float y = ((const float *)of->data)[3 * i + 1];
    if (y < least) least = y;
    if (y > most) most = y;
  }
  return most - least;
}

static void read(const char *path, Packed *vertices, Packed *triangles) {
  FILE *file = fopen(path, "r");
  CHECK(file);
  for (char line[256]; fgets(line, sizeof line, file);) {
    float p[3];
    int t[3];
    if (sscanf(line, "v %f %f %f", &p[0], &p[1], &p[2]) == 3) {
      resize(VECTORS, vertices, vertices->count + 1);
      memcpy((float *)vertices->data + 3 * vertices->count - 3, p, sizeof p);
    }
    if (sscanf(line, "f %d %d %d", &t[0], &t[1], &t[2]) == 3) {
      resize(INTS, triangles, triangles->count + 3);
      for (int i = 0; i < 3; i++) ((int32_t *)triangles->data)[triangles->count - 3 + i] = t[i] - 1;
    }
  }
  fclose(file);
}

int main(int argc, char **argv) {
  CHECK(argc == 3);
  int library;
  GDExtensionInitialization levels = {0};
  CHECK(superdeform_godot_init(get, (GDExtensionClassLibraryPtr)&library, &levels));
  for (int level = GDEXTENSION_INITIALIZATION_CORE; level < GDEXTENSION_MAX_INITIALIZATION_LEVEL; level++)
    if (level >= (int)levels.minimum_initialization_level)
      levels.initialize(levels.userdata, (GDExtensionInitializationLevel)level);
  CHECK(method_count == 4 && alive == 0);
  CHECK(registered.create_instance_func(registered.class_userdata) == &objects && objects == 1);

  enum { VERTICES, NORMALS, TRIANGLES, STYLE };
  Variant figure[4] = {{VECTORS, {0}}, {VECTORS, {0}}, {INTS, {0}}, {STRING, {0}}}, whole = {INT, {.integer = 1}};
  Packed *vertices = &figure[VERTICES].value.packed, *normals = &figure[NORMALS].value.packed;
  GDExtensionCallError error;
  for (int i = 0; i < STYLE; i++) make_packed(&figure[i].value, NULL);
  new_text(&figure[STYLE].value, "sd2.5");
  printf("no figure: %s\n", said(call("open", figure, 4, &error)));
  printf("not open: %s\n", said(call("apply", &whole, 1, &error)));
  read(argv[1], vertices, &figure[TRIANGLES].value.packed);
  resize(VECTORS, normals, 1);
  printf("too few normals: %s\n", said(call("open", figure, 4, &error)));
  resize(VECTORS, normals, vertices->count);
  for (GDExtensionInt i = 0; i < 3 * normals->count; i++) ((float *)normals->data)[i] = i % 3 == 1;
  destroy_text(&figure[STYLE].value);
  new_text(&figure[STYLE].value, "sd9000");
  printf("no such style: %s\n", said(call("open", figure, 4, &error)));
  call("open", figure, 3, &error);
  CHECK(error.error == GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS && error.expected == 4);
  const Variant swapped[4] = {figure[TRIANGLES], figure[NORMALS], figure[VERTICES], figure[STYLE]};
  call("open", swapped, 4, &error);
  CHECK(error.error == GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT && error.argument == 0 && error.expected == (int)VECTORS);

  destroy_text(&figure[STYLE].value);
  new_text(&figure[STYLE].value, "sd2.5");
  const char *wrong = said(call("open", figure, 4, &error));
  CHECK(error.error == GDEXTENSION_CALL_OK);
  for (int step = 0; step < 5 && !*wrong; step++) {
    const Variant amount = {FLOAT, {.number = step / 4.0}};
    wrong = said(step == 4 ? call("apply", &whole, 1, &error) : call("apply", &amount, 1, &error));
    Packed moved = vectors("vertices"), turned = vectors("normals");
    CHECK(moved.count == vertices->count && turned.count == vertices->count);
    for (GDExtensionInt i = 0; i < turned.count; i++) {
      const float *n = (const float *)turned.data + 3 * i;
      const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
      CHECK(square > 0.999f && square < 1.001f);
    }
    printf("amount %.2f: %.6f tall\n", amount.value.number, height(&moved));
    FILE *file = fopen(argv[2], "wb");
    CHECK(file && fwrite(moved.data, 12, (size_t)moved.count, file) == (size_t)moved.count && fclose(file) == 0);
    destroy_packed(&moved);
    destroy_packed(&turned);
  }
  if (*wrong) return printf("wrong: %s\n", wrong), 1;

  registered.free_instance_func(registered.class_userdata, instance);
  for (int i = 0; i < STYLE; i++) destroy_packed(&figure[i].value);
  destroy_text(&figure[STYLE].value);
  for (int level = GDEXTENSION_MAX_INITIALIZATION_LEVEL - 1; level >= (int)levels.minimum_initialization_level; level--)
    levels.deinitialize(levels.userdata, (GDExtensionInitializationLevel)level);
  CHECK(method_count == 0);
  printf("%d values left behind\n", alive);
  return alive != 0;
}
