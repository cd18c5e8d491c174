// Depth-buffer march (refraction/narrow/march_depth.h).
#include "refraction/narrow/march_depth.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {

// An end of the line: its place, the depth over w (for perspective 1) and 1 / w.
struct End {
  LayerPlace<WideF> place;
  WideF q, k;
};

End project_end(const View& view, Vec3<WideF> p, WideF depth_m) {
  const ClipVertex<WideF> clip = project(view, p);
  const WideF k = WideF(1.0f) / max(clip.w, WideF(1e-6f));
  return {{clip.x * k + WideF(view.centre_px.x), clip.y * k + WideF(view.centre_px.y)}, depth_m * k, k};
}

SHOAL_INLINE WideF depth_of(const View& view, Vec3<WideF> p) {
  return dot(broadcast<WideF>(view.row_w), p - broadcast<WideF>(view.camera.position_world));
}

}  // namespace

MarchedPlace march_depth(const SampleIn& in, Vec3<WideF> from, Vec3<WideF> to, WideF jitter, const DepthMarch& how) {
  const View& view = in.view();
  const FrameGrid& frame = in.narrow.grids.frame;
  const LayerView& layer = in.narrow.layer;
  const WideF one(1.0f), half(0.5f);

  // Cut at the near plane.
  const WideF near_m(view.camera.near_m), depth_from = depth_of(view, from), depth_to = depth_of(view, to);
  const WideM behind = depth_to < near_m;
  const WideF cut = (depth_from - near_m) / select(behind, max(depth_from - depth_to, WideF(1e-6f)), one);
  const Vec3<WideF> end = select<WideF>(behind, from + (to - from) * clamp(cut, WideF(0.0f), one), to);
  const End a = project_end(view, from, depth_from), b = project_end(view, end, max(depth_of(view, end), near_m));

  // Steps along the longer axis; a line of no length still samples one pixel.
  const WideF dx = b.place.x_px - a.place.x_px, dy = b.place.y_px - a.place.y_px;
  const WideF share = WideF(how.stride_px) / max(max(abs(dx), abs(dy)), WideF(0.01f));
  const WideF dq = b.q - a.q, dk = b.k - a.k;
  const WideF width(static_cast<float>(frame.width_px)), height(static_cast<float>(frame.height_px));
  const WideI margin(layer.grid().margin_px);

  WideM open = in.lanes, any_hit = mask_from_bits(0);
  LayerPlace<WideF> found = own_place(in.block.x_px, in.block.y_px);
  WideF previous = depth_from, gap_before(0.0f);
  for (int i = 0; i < how.max_steps && any(open); ++i) {
    const WideF u = (WideF(static_cast<float>(i)) + jitter) * share;
    const WideF x = a.place.x_px + dx * u, y = a.place.y_px + dy * u;
    open = open & (u <= one) & (x >= WideF(0.0f)) & (y >= WideF(0.0f)) & (x < width) & (y < height);
    if (none(open)) break;
    const WideI x_px = to_int_trunc(select(open, x, WideF(0.0f))), y_px = to_int_trunc(select(open, y, WideF(0.0f)));
    const WideI slot = pixel_slots(layer.grid().grid, x_px + margin, y_px + margin);
    const WideF drawn = gather(layer.depth(), slot, open, WideF(0.0f));
    const WideM shows = open & (drawn > WideF(0.0f));
    const WideF scene = view_depth_m(view, select(shows, drawn, one));
    const WideF u_here = how.solid ? u : u + share * half;
    const WideF here = (a.q + dq * u_here) / (a.k + dk * u_here);
    const WideF nearer = min(previous, here), farther = max(previous, here);
    WideM hit = shows & (farther >= scene);
    if (!how.solid) hit = hit & (nearer <= scene + WideF(how.thickness_m));
    LayerPlace<WideF> place{to_float(x_px) + half, to_float(y_px) + half};
    if (how.solid) {
      // Between the last step in front and this one, as if the buffer were straight there.
      const WideF gap = here - scene, sum = gap - gap_before;
      const WideF back =
          select((gap_before < WideF(0.0f)) & (sum > WideF(0.0f)), gap / max(sum, WideF(1e-20f)), WideF(0.0f));
      const WideF at = u - share * clamp(back, WideF(0.0f), one);
      place = {a.place.x_px + dx * at, a.place.y_px + dy * at};
      gap_before = select(shows, gap, WideF(0.0f));
    }
    found = select_place(hit, place, found);
    any_hit = any_hit | hit;
    open = open & !hit;
    previous = here;
  }
  return {found, any_hit};
}

}  // namespace shoal::inline SHOAL_ISA_NS
