// Hosts with threads of their own.
#include "hosts.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>

static void run(int count, const std::function<void(int)> &work) {
  std::vector<std::thread> threads;
  for (int thread = 0; thread < count; thread++) threads.emplace_back([&work, thread] { work(thread); });
  for (std::thread &thread : threads) thread.join();
}

static std::vector<float> expected() {
  return deformed(superdeform::Deformer(character(), superdeform::Style::from_heads(2.5)));
}

static void eight_hosts_do_not_meet() {
  const std::vector<float> same = expected();
  std::atomic<int> right{0};
  run(8, [&](int host) {
    superdeform::Options options;
    options.thread_count = static_cast<std::uint32_t>(host % 3);
    for (int round = 0; round < 3; round++) {
      const superdeform::Character made = character();
      const superdeform::Deformer deformer(made, superdeform::Style::from_heads(2.5), options);
      if (deformed(deformer) == same) right++;
    }
  });
  CHECK(right == 24);
}

static void one_character_is_read_by_many() {
  const superdeform::Character made = character();
  const superdeform::Style style = superdeform::Style::from_heads(2.5);
  const superdeform::Deformer deformer(made, style);
  const std::vector<float> same = expected();
  std::atomic<int> right{0};
  run(8, [&](int) {
    for (int round = 0; round < 5; round++) {
      const bool as_it_is = made.info().vertex_count == FIGURE_VERTICES && made.joints().parents.size() == FIGURE_PARTS;
      const superdeform::Deformer own(made, style);
      if (as_it_is && deformed(own) == same && deformed(deformer) == same && deformer.figure(SDEF_FIGURE_TARGET).heads > 5)
        right++;
    }
  });
  CHECK(right == 40);
}

static void one_changes_beside_readers() {
  superdeform::Character made = character();
  const superdeform::Style style = superdeform::Style::from_heads(2.5);
  superdeform::Deformer deformer(made, style);
  const std::vector<float> same = expected();
  superdeform::Options none;
  none.amount = 0;
  const std::vector<float> original = deformed(superdeform::Deformer(made, style, none));
  std::atomic<bool> over{false};
  std::atomic<int> changes{0}, reads{0}, busy{0}, wrong{0};
  const auto attempt = [&](std::atomic<int> &count, const std::function<void()> &call) {
    try {
      call();
      count++;
    } catch (const superdeform::Error &error) {
      if (error.status() == SDEF_STATUS_BUSY) busy++;
      else wrong++;
    }
  };
  run(5, [&](int thread) {
    if (thread == 0) {
      for (int round = 0; round < 200; round++) {
        attempt(changes, [&] { made.set_skeleton(figure().skeleton); });
        attempt(changes, [&] { deformer.set_options(round % 2 == 0 ? none : superdeform::Options()); });
        attempt(changes, [&] {
          superdeform::Options face;
          face.face_squash = 0.1 * (round % 5);
          deformer.set_options(face);
        });
      }
      over = true;
      return;
    }
    do {
      attempt(reads, [&] {
        if (made.info().joint_count != FIGURE_PARTS) wrong++;
      });
      attempt(reads, [&] {
        // One state or the other, never something between: the heights tell.
        const std::vector<float> positions = deformed(deformer);
        float top = 0;
        for (std::size_t i = 1; i < positions.size(); i += 3) top = std::max(top, positions[i]);
        if (!(top > 0.1f && top < 2)) wrong++;
      });
    } while (!over);
  });
  CHECK(wrong == 0 && changes > 0 && reads > 0);
  printf("%d changes, %d reads, %d times busy\n", changes.load(), reads.load(), busy.load());
  deformer.set_options(none);
  CHECK(deformed(deformer) == original);
  deformer.set_options(superdeform::Options());
  CHECK(deformed(deformer) == same);
}

static void what_is_destroyed_elsewhere_ends_with_its_last_use() {
  for (int round = 0; round < 50; round++) {
    superdeform::Character made = character();
    const superdeform::Style style = superdeform::Style::from_heads(2.5);
    std::atomic<int> wrong{0};
    run(3, [&](int thread) {
      if (thread == 0) {
        sdef_destroy(made.get().id, nullptr);
        return;
      }
      try {
        const superdeform::Deformer deformer(made, style);
      } catch (const superdeform::Error &error) {
        if (error.status() != SDEF_STATUS_BAD_HANDLE) wrong++;
      }
    });
    made.release();
    CHECK(wrong == 0);
  }
}

static void a_callback_that_changes_what_calls_it_is_told_so() {
  superdeform::Character made = character();
  const superdeform::Style style = superdeform::Style::from_heads(2.5);
  SdefStatus inside = SDEF_STATUS_OK;
  std::uint64_t calls = 0;
  superdeform::Options options;
  options.rig_voxel_resolution = 32;
  made.rig(options, [&](float) {
    calls++;
    inside = sdef_character_add_mesh(made.get(), &figure().mesh, nullptr, nullptr);
  });
  CHECK(calls > 0 && inside == SDEF_STATUS_BUSY && made.info().mesh_count == 1);
  // A deformer has read all that it needs before it begins.
  superdeform::Deformer deformer(made, style, superdeform::Options(), [&](float) {
    inside = sdef_character_add_mesh(made.get(), &figure().mesh, nullptr, nullptr);
  });
  CHECK(inside == SDEF_STATUS_OK && made.info().mesh_count > 1);
  Positions positions;
  deformer.apply({&positions.result, 1}, [&](float) {
    inside = sdef_deformer_set_options(deformer.get(), nullptr, nullptr, nullptr, nullptr);
  });
  CHECK(inside == SDEF_STATUS_BUSY);
  deformer.set_options(options);
  // Other threads see it too.
  deformer.apply({&positions.result, 1}, [&](float) {
    std::thread([&] { inside = sdef_deformer_set_options(deformer.get(), nullptr, nullptr, nullptr, nullptr); }).join();
  });
  CHECK(inside == SDEF_STATUS_BUSY);
  // Reading is allowed.
  double heads = 0;
  deformer.apply({&positions.result, 1}, [&](float) { heads = deformer.figure(SDEF_FIGURE_RESULT).heads; });
  CHECK(heads > 1);
}

static void progress_comes_on_the_callers_thread() {
  const std::thread::id own = std::this_thread::get_id();
  bool elsewhere = false;
  superdeform::Options options;
  options.thread_count = 8;
  superdeform::Character made = character();
  const auto look = [&](float) { elsewhere |= std::this_thread::get_id() != own; };
  const superdeform::Deformer deformer(made, superdeform::Style::from_heads(2.5), options, look);
  options.rig_voxel_resolution = 32;
  made.rig(options, look);
  CHECK(!elsewhere);
}

// A job system with threads of its own: results are the same bits, progress still comes here.
static void a_hosts_own_threads_do_the_work() {
  const std::vector<float> same = expected();
  std::atomic<int> tasks{0};
  const SdefJobs jobs = [](void *user, SdefTask task, void *data, uint32_t count) {
    run(static_cast<int>(count), [&](int index) {
      task(data, static_cast<uint32_t>(index));
      ++*static_cast<std::atomic<int> *>(user);
    });
  };
  OK(sdef_set_jobs(jobs, &tasks, nullptr));
  const superdeform::Character made = character();
  superdeform::Options options;
  options.thread_count = 3;
  const std::thread::id here = std::this_thread::get_id();
  bool is_here = true;
  const superdeform::Deformer deformer(made, superdeform::Style::from_heads(2.5), options, [&](float) {
    is_here = is_here && std::this_thread::get_id() == here;
  });
  CHECK(deformed(deformer) == same && is_here);
  auto bare = superdeform::Character::create();
  SdefMesh mesh = figure().mesh;
  mesh.influence_count = 0;
  mesh.joints = mesh.weights = nullptr;
  mesh.joint_stride = mesh.weight_stride = 0;
  bare.add_mesh(mesh);
  options.rig_voxel_resolution = 32;
  bare.rig(options);
  CHECK(tasks > 0);
  OK(sdef_set_jobs(nullptr, nullptr, nullptr));
}

int main() {
  figure();
  RUN(eight_hosts_do_not_meet);
  RUN(one_character_is_read_by_many);
  RUN(one_changes_beside_readers);
  RUN(what_is_destroyed_elsewhere_ends_with_its_last_use);
  RUN(a_callback_that_changes_what_calls_it_is_told_so);
  RUN(progress_comes_on_the_callers_thread);
  RUN(a_hosts_own_threads_do_the_work);
  return REPORT();
}
