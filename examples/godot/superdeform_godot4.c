// superdeform in Godot 4.2 and later (GDExtension): the class SuperDeform, a RefCounted.
//
//   open(vertices: PackedVector3Array, normals: PackedVector3Array, triangles: PackedInt32Array, style: String) -> String
//   apply(amount: float) -> String
//   vertices() -> PackedVector3Array, normals() -> PackedVector3Array
//
// open and apply give "", or the sentence that says what is wrong. vertices and normals are those of the last apply;
// normals is empty where open got none.
//
// For engines whose real numbers are floats, as those that godotengine.org offers are.
#include "deformed.h"
#include <gdextension_interface.h>

// As extension_api.json has them for 64 bits.
typedef struct { _Alignas(8) unsigned char bytes[8]; } String;
typedef struct { _Alignas(8) unsigned char bytes[8]; } StringName;
typedef struct { _Alignas(8) unsigned char bytes[16]; } Packed;
static const GDExtensionInt SIZE_HASH = 3173160232, RESIZE_HASH = 848867239;

#define NIL GDEXTENSION_VARIANT_TYPE_NIL
#define FLOAT GDEXTENSION_VARIANT_TYPE_FLOAT
#define STRING GDEXTENSION_VARIANT_TYPE_STRING
#define NAME GDEXTENSION_VARIANT_TYPE_STRING_NAME
#define INTS GDEXTENSION_VARIANT_TYPE_PACKED_INT32_ARRAY
#define VECTORS GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR3_ARRAY
enum { MOST_ARGUMENTS = 4, PROPERTY_USAGE_DEFAULT = 6 };

static GDExtensionClassLibraryPtr library;
static GDExtensionInterfaceStringNewWithUtf8Chars new_string;
static GDExtensionInterfaceStringToUtf8Chars string_to_utf8;
static GDExtensionInterfaceStringNameNewWithLatin1Chars new_name;
static GDExtensionInterfacePackedVector3ArrayOperatorIndex vector_at;
static GDExtensionInterfacePackedVector3ArrayOperatorIndexConst vector_of;
static GDExtensionInterfacePackedInt32ArrayOperatorIndexConst int_of;
static GDExtensionInterfaceVariantGetPtrConstructor constructor_of;
static GDExtensionInterfaceVariantGetPtrDestructor destructor_of;
static GDExtensionInterfaceVariantGetPtrBuiltinMethod method_of;
static GDExtensionInterfaceGetVariantFromTypeConstructor to_variant;
static GDExtensionInterfaceGetVariantToTypeConstructor from_variant;
static GDExtensionInterfaceVariantGetType type_of;
static GDExtensionInterfaceClassdbRegisterExtensionClass2 register_class;
static GDExtensionInterfaceClassdbRegisterExtensionClassMethod register_method;
static GDExtensionInterfaceClassdbUnregisterExtensionClass unregister_class;
static GDExtensionInterfaceClassdbConstructObject construct_object;
static GDExtensionInterfaceObjectSetInstance set_instance;
static GDExtensionPtrBuiltInMethod size_of_vectors, size_of_ints, resize_vectors;

// What a call gets is an engine's value that is made already: it is taken away, and a new one put in its place.
static void give_text(GDExtensionTypePtr to, const char *utf8) {
  destructor_of(STRING)(to);
  new_string(to, utf8);
}

static void give_sentence(GDExtensionTypePtr to, SdefStatus status, const SdefError *error) {
  if (status == SDEF_STATUS_OK) give_text(to, "");
  else give_text(to, error->message[0] ? error->message : sdef_status_name(status));
}

static void give_vectors(GDExtensionTypePtr to, const float *vectors, uint32_t count) {
  GDExtensionInt size = vectors ? count : 0, failed = 0;
  const GDExtensionConstTypePtr arguments[] = {&size};
  resize_vectors(to, arguments, &failed, 1);
  if (size > 0 && failed == 0) memcpy(vector_at(to, 0), vectors, 3 * sizeof(float) * count);
}

static GDExtensionInt size(GDExtensionPtrBuiltInMethod method, GDExtensionConstTypePtr of) {
  GDExtensionInt count = 0;
  method((GDExtensionTypePtr)of, NULL, &count, 0);
  return count;
}

static void open(void *data, GDExtensionClassInstancePtr deformed, const GDExtensionConstTypePtr *arguments,
                 GDExtensionTypePtr result) {
  (void)data;
  SdefError error = SDEF_ERROR_INIT;
  const GDExtensionInt vertex_count = size(size_of_vectors, arguments[0]), normal_count = size(size_of_vectors, arguments[1]);
  const GDExtensionInt index_count = size(size_of_ints, arguments[2]);
  if (normal_count != 0 && normal_count != vertex_count) {
    give_text(result, "there are normals, but not one for each vertex: give as many, or none");
    return;
  }
  const GDExtensionInt length = string_to_utf8(arguments[3], NULL, 0);
  char *style = (char *)calloc((size_t)length + 1, 1);
  SdefStatus status = SDEF_STATUS_OUT_OF_MEMORY;
  if (style) {
    string_to_utf8(arguments[3], style, length);
    // A Vector3 of Godot is three floats.
    const float *points = vertex_count ? (const float *)vector_of(arguments[0], 0) : NULL;
    const float *directions = normal_count ? (const float *)vector_of(arguments[1], 0) : NULL;
    const int32_t *triangles = index_count ? int_of(arguments[2], 0) : NULL;
    status = deformed_open((Deformed *)deformed, points, directions, (uint32_t)vertex_count, triangles, (size_t)index_count,
                           style, &error);
  }
  free(style);
  give_sentence(result, status, &error);
}

static void apply(void *data, GDExtensionClassInstancePtr deformed, const GDExtensionConstTypePtr *arguments,
                  GDExtensionTypePtr result) {
  (void)data;
  SdefError error = SDEF_ERROR_INIT;
  give_sentence(result, deformed_apply((Deformed *)deformed, *(const double *)arguments[0], &error), &error);
}

static void vertices(void *data, GDExtensionClassInstancePtr deformed, const GDExtensionConstTypePtr *arguments,
                     GDExtensionTypePtr result) {
  (void)data, (void)arguments;
  give_vectors(result, ((Deformed *)deformed)->positions, ((Deformed *)deformed)->vertex_count);
}

static void normals(void *data, GDExtensionClassInstancePtr deformed, const GDExtensionConstTypePtr *arguments,
                    GDExtensionTypePtr result) {
  (void)data, (void)arguments;
  give_vectors(result, ((Deformed *)deformed)->normals, ((Deformed *)deformed)->vertex_count);
}

typedef struct {
  const char *name;
  GDExtensionClassMethodPtrCall call;
  GDExtensionVariantType result;
  int argument_count;
  GDExtensionVariantType argument_types[MOST_ARGUMENTS];
  const char *argument_names[MOST_ARGUMENTS];
} Method;
static Method methods[] = {
    {"open", open, STRING, 4, {VECTORS, VECTORS, INTS, STRING}, {"vertices", "normals", "triangles", "style"}},
    {"apply", apply, STRING, 1, {FLOAT}, {"amount"}},
    {"vertices", vertices, VECTORS, 0, {NIL}, {NULL}},
    {"normals", normals, VECTORS, 0, {NIL}, {NULL}},
};
enum { METHODS = sizeof methods / sizeof *methods };

// Large enough for every type above.
typedef union { double number; String string; Packed packed; } Value;

static void make(GDExtensionVariantType type, Value *value) {
  if (type == FLOAT) value->number = 0;
  else constructor_of(type, 0)(value, NULL);
}

static void destroy(GDExtensionVariantType type, Value *value) {
  if (type != FLOAT) destructor_of(type)(value);
}

// A call by variants: they are turned into what the call by pointers takes. As the engine's own methods, a whole number
// serves for a number.
static void call(void *data, GDExtensionClassInstancePtr deformed, const GDExtensionConstVariantPtr *arguments,
                 GDExtensionInt count, GDExtensionVariantPtr returned, GDExtensionCallError *error) {
  const Method *method = (const Method *)data;
  Value values[MOST_ARGUMENTS], result;
  GDExtensionConstTypePtr pointers[MOST_ARGUMENTS];
  error->error = GDEXTENSION_CALL_OK;
  if (count != method->argument_count) {
    error->error = count < method->argument_count ? GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS
                                                  : GDEXTENSION_CALL_ERROR_TOO_MANY_ARGUMENTS;
    error->argument = error->expected = method->argument_count;
    return;
  }
  for (int i = 0; i < method->argument_count; i++) {
    const GDExtensionVariantType type = type_of(arguments[i]), asked = method->argument_types[i];
    if (type == asked || (asked == FLOAT && type == GDEXTENSION_VARIANT_TYPE_INT)) continue;
    error->error = GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT;
    error->argument = i;
    error->expected = asked;
    return;
  }
  for (int i = 0; i < method->argument_count; i++) {
    from_variant(method->argument_types[i])(&values[i], (GDExtensionVariantPtr)arguments[i]);
    pointers[i] = &values[i];
  }
  make(method->result, &result);
  method->call(NULL, deformed, pointers, &result);
  to_variant(method->result)(returned, &result);
  destroy(method->result, &result);
  for (int i = 0; i < method->argument_count; i++) destroy(method->argument_types[i], &values[i]);
}

static GDExtensionObjectPtr create_instance(void *data) {
  (void)data;
  StringName name, parent;
  new_name(&name, "SuperDeform", 0);
  new_name(&parent, "RefCounted", 0);
  GDExtensionObjectPtr object = construct_object(&parent);
  set_instance(object, &name, calloc(1, sizeof(Deformed)));
  destructor_of(NAME)(&parent);
  destructor_of(NAME)(&name);
  return object;
}

static void free_instance(void *data, GDExtensionClassInstancePtr deformed) {
  (void)data;
  deformed_close((Deformed *)deformed);
  free(deformed);
}

// One value of a method: what it is, and what it is called.
static GDExtensionPropertyInfo property(GDExtensionVariantType type, StringName *name, StringName *no_class, String *no_hint) {
  return (GDExtensionPropertyInfo){type, name, no_class, 0, no_hint, PROPERTY_USAGE_DEFAULT};
}

static void add_method(StringName *class_name, Method *method) {
  StringName name, no_class, names[MOST_ARGUMENTS];
  String no_hint;
  GDExtensionPropertyInfo arguments[MOST_ARGUMENTS];
  GDExtensionClassMethodArgumentMetadata metadata[MOST_ARGUMENTS] = {GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE};
  GDExtensionClassMethodInfo info = {0};
  new_name(&name, method->name, 0);
  new_name(&no_class, "", 0);
  new_string(&no_hint, "");
  for (int i = 0; i < method->argument_count; i++) {
    new_name(&names[i], method->argument_names[i], 0);
    arguments[i] = property(method->argument_types[i], &names[i], &no_class, &no_hint);
  }
  GDExtensionPropertyInfo result = property(method->result, &no_class, &no_class, &no_hint);
  info.name = &name;
  info.method_userdata = method;
  info.call_func = call;
  info.ptrcall_func = method->call;
  info.method_flags = GDEXTENSION_METHOD_FLAGS_DEFAULT;
  info.has_return_value = 1;
  info.return_value_info = &result;
  info.argument_count = (uint32_t)method->argument_count;
  info.arguments_info = arguments;
  info.arguments_metadata = metadata;
  register_method(library, class_name, &info);
  for (int i = 0; i < method->argument_count; i++) destructor_of(NAME)(&names[i]);
  destructor_of(STRING)(&no_hint);
  destructor_of(NAME)(&no_class);
  destructor_of(NAME)(&name);
}

static GDExtensionPtrBuiltInMethod builtin(GDExtensionVariantType type, const char *method, GDExtensionInt hash) {
  StringName name;
  new_name(&name, method, 0);
  GDExtensionPtrBuiltInMethod found = method_of(type, &name, hash);
  destructor_of(NAME)(&name);
  return found;
}

static void initialize(void *data, GDExtensionInitializationLevel level) {
  (void)data;
  if (level != GDEXTENSION_INITIALIZATION_SCENE) return;
  size_of_vectors = builtin(VECTORS, "size", SIZE_HASH);
  size_of_ints = builtin(INTS, "size", SIZE_HASH);
  resize_vectors = builtin(VECTORS, "resize", RESIZE_HASH);
  StringName name, parent;
  GDExtensionClassCreationInfo2 info = {0};
  info.is_exposed = 1;
  info.create_instance_func = create_instance;
  info.free_instance_func = free_instance;
  new_name(&name, "SuperDeform", 0);
  new_name(&parent, "RefCounted", 0);
  register_class(library, &name, &parent, &info);
  for (int i = 0; i < METHODS; i++) add_method(&name, &methods[i]);
  destructor_of(NAME)(&parent);
  destructor_of(NAME)(&name);
}

static void deinitialize(void *data, GDExtensionInitializationLevel level) {
  (void)data;
  if (level != GDEXTENSION_INITIALIZATION_SCENE) return;
  StringName name;
  new_name(&name, "SuperDeform", 0);
  unregister_class(library, &name);
  destructor_of(NAME)(&name);
}

#define FIND(to, type, name) (((to) = (type)(void (*)(void))get(name)) != NULL)

// false where the engine is older than 4.2, and lacks what is called.
GDExtensionBool superdeform_godot_init(GDExtensionInterfaceGetProcAddress get, GDExtensionClassLibraryPtr of,
                                       GDExtensionInitialization *initialization) {
  library = of;
  initialization->minimum_initialization_level = GDEXTENSION_INITIALIZATION_SCENE;
  initialization->initialize = initialize;
  initialization->deinitialize = deinitialize;
  return FIND(new_string, GDExtensionInterfaceStringNewWithUtf8Chars, "string_new_with_utf8_chars") &&
         FIND(string_to_utf8, GDExtensionInterfaceStringToUtf8Chars, "string_to_utf8_chars") &&
         FIND(new_name, GDExtensionInterfaceStringNameNewWithLatin1Chars, "string_name_new_with_latin1_chars") &&
         FIND(vector_at, GDExtensionInterfacePackedVector3ArrayOperatorIndex, "packed_vector3_array_operator_index") &&
         FIND(vector_of, GDExtensionInterfacePackedVector3ArrayOperatorIndexConst,
              "packed_vector3_array_operator_index_const") &&
         FIND(int_of, GDExtensionInterfacePackedInt32ArrayOperatorIndexConst, "packed_int32_array_operator_index_const") &&
         FIND(constructor_of, GDExtensionInterfaceVariantGetPtrConstructor, "variant_get_ptr_constructor") &&
         FIND(destructor_of, GDExtensionInterfaceVariantGetPtrDestructor, "variant_get_ptr_destructor") &&
         FIND(method_of, GDExtensionInterfaceVariantGetPtrBuiltinMethod, "variant_get_ptr_builtin_method") &&
         FIND(to_variant, GDExtensionInterfaceGetVariantFromTypeConstructor, "get_variant_from_type_constructor") &&
         FIND(from_variant, GDExtensionInterfaceGetVariantToTypeConstructor, "get_variant_to_type_constructor") &&
         FIND(type_of, GDExtensionInterfaceVariantGetType, "variant_get_type") &&
         FIND(register_class, GDExtensionInterfaceClassdbRegisterExtensionClass2, "classdb_register_extension_class2") &&
         FIND(register_method, GDExtensionInterfaceClassdbRegisterExtensionClassMethod,
              "classdb_register_extension_class_method") &&
         FIND(unregister_class, GDExtensionInterfaceClassdbUnregisterExtensionClass,
              "classdb_unregister_extension_class") &&
         FIND(construct_object, GDExtensionInterfaceClassdbConstructObject, "classdb_construct_object") &&
         FIND(set_instance, GDExtensionInterfaceObjectSetInstance, "object_set_instance");
}
