// A page that draws a picture by itself: the arrays in base64 and a renderer like that of picture_png.cpp.
#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <cstring>
#include <span>

#include "hextwist/base/text.h"
#include "hextwist/session/view/picture.h"

namespace hextwist {
namespace {

constexpr const char* page_head = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>%TITLE%</title>
<style>
body{margin:0;overflow:hidden;font:14px sans-serif;background:#fff;color:#333}
canvas{display:block;width:100vw;height:100vh;cursor:grab}
#key,#tip,#help{position:absolute;pointer-events:none;background:#ffffffcc;padding:4px 8px;border-radius:4px}
#key{left:8px;top:8px}#tip{display:none}#help{right:8px;bottom:8px;color:#888}
#key i{display:inline-block;width:12px;height:12px;margin-right:6px;border-radius:2px}
#bar{width:14px;height:160px;display:inline-block;vertical-align:middle;margin-right:8px}
</style></head><body>
<canvas id="view"></canvas><div id="key"></div><div id="tip"></div>
<div id="help">drag: turn &middot; shift or right button: move &middot; wheel: zoom &middot; double click: reset &middot; click: which hex</div>
<script>
"use strict";
const scene=)html";

constexpr const char* page_tail = R"html(;
const bytes=t=>Uint8Array.from(atob(t),c=>c.charCodeAt(0));
const P=new Float32Array(bytes(scene.points).buffer),Q=new Uint32Array(bytes(scene.quads).buffer),
      C=bytes(scene.colours),H=new Float64Array(bytes(scene.hexes).buffer),V=new Float32Array(bytes(scene.values).buffer),
      L=new Float32Array(bytes(scene.lines).buffer);
const canvas=document.getElementById("view"),pen=canvas.getContext("2d");
const unit=a=>{const n=Math.hypot(...a)||1;return a.map(x=>x/n)},dot=(a,b)=>a[0]*b[0]+a[1]*b[1]+a[2]*b[2];
const cross=(a,b)=>[a[1]*b[2]-a[2]*b[1],a[2]*b[0]-a[0]*b[2],a[0]*b[1]-a[1]*b[0]];
let right,up,eye,zoom,shiftX,shiftY,W,H2,image,pixels,depth,owner,scale;
function reset(){right=scene.right;up=scene.up;eye=scene.eye;zoom=1;shiftX=shiftY=0}
function resize(){
  const r=Math.min(window.devicePixelRatio||1,2);
  W=canvas.width=Math.max(1,Math.round(window.innerWidth*r));H2=canvas.height=Math.max(1,Math.round(window.innerHeight*r));
  image=pen.createImageData(W,H2);pixels=new Uint32Array(image.data.buffer);
  depth=new Float32Array(W*H2);owner=new Int32Array(W*H2);draw();
}
const rgba=(r,g,b)=>(255<<24|b<<16|g<<8|r)>>>0;
function put(at,z,r,g,b,a,who){
  if(z<depth[at])return;
  if(a>=.5){depth[at]=z;owner[at]=who}
  const o=pixels[at],k=1-a;
  pixels[at]=rgba(a*r+k*(o&255),a*g+k*(o>>8&255),a*b+k*(o>>16&255));
}
let S=new Float64Array(0);
function triangle(a,b,c,mask,strength,shade,q){
  const ax=S[3*a],ay=S[3*a+1],az=S[3*a+2],bx=S[3*b],by=S[3*b+1],bz=S[3*b+2],cx=S[3*c],cy=S[3*c+1],cz=S[3*c+2];
  const area=(bx-ax)*(cy-ay)-(by-ay)*(cx-ax);
  if(!(Math.abs(area)>1e-6))return;
  const x0=Math.max(0,Math.floor(Math.min(ax,bx,cx))),x1=Math.min(W-1,Math.ceil(Math.max(ax,bx,cx)));
  const y0=Math.max(0,Math.floor(Math.min(ay,by,cy))),y1=Math.min(H2-1,Math.ceil(Math.max(ay,by,cy)));
  const t=Math.abs(area),ha=t/Math.hypot(bx-cx,by-cy),hb=t/Math.hypot(cx-ax,cy-ay),hc=t/Math.hypot(ax-bx,ay-by);
  const r=C[3*q]*shade,g=C[3*q+1]*shade,l=C[3*q+2]*shade;
  for(let y=y0;y<=y1;++y)for(let x=x0;x<=x1;++x){
    const px=x+.5,py=y+.5;
    const u=((cx-bx)*(py-by)-(cy-by)*(px-bx))/area,v=((ax-cx)*(py-cy)-(ay-cy)*(px-cx))/area,w=1-u-v;
    if(u<0||v<0||w<0)continue;
    const z=u*az+v*bz+w*cz,at=y*W+x;
    if(z<depth[at])continue;
    let near=1e9;
    if(mask&1)near=Math.min(near,w*hc);
    if(mask&2)near=Math.min(near,u*ha);
    if(mask&4)near=Math.min(near,v*hb);
    const k=1-.65*strength*Math.max(0,Math.min(1,1.1-near));
    depth[at]=z;owner[at]=q;pixels[at]=rgba(r*k,g*k,l*k);
  }
}
function project(x,y,z){
  return [W/2+shiftX+scale*(right[0]*x+right[1]*y+right[2]*z),H2/2+shiftY-scale*(up[0]*x+up[1]*y+up[2]*z),
          scale*(eye[0]*x+eye[1]*y+eye[2]*z)];
}
function line(i){
  const a=project(L[i],L[i+1],L[i+2]),b=project(L[i+3],L[i+4],L[i+5]),radius=Math.max(.6,L[i+6]*Math.min(W,H2)/2000);
  const dx=b[0]-a[0],dy=b[1]-a[1],square=dx*dx+dy*dy,nearer=L[i+10]?1e9:2*radius+1;
  const x0=Math.max(0,Math.floor(Math.min(a[0],b[0])-radius-1)),x1=Math.min(W-1,Math.ceil(Math.max(a[0],b[0])+radius+1));
  const y0=Math.max(0,Math.floor(Math.min(a[1],b[1])-radius-1)),y1=Math.min(H2-1,Math.ceil(Math.max(a[1],b[1])+radius+1));
  for(let y=y0;y<=y1;++y)for(let x=x0;x<=x1;++x){
    const px=x+.5-a[0],py=y+.5-a[1],t=square>0?Math.max(0,Math.min(1,(px*dx+py*dy)/square)):0;
    const o=Math.max(0,Math.min(1,radius+.5-Math.hypot(px-t*dx,py-t*dy)));
    if(o>0)put(y*W+x,a[2]+t*(b[2]-a[2])+nearer,L[i+7],L[i+8],L[i+9],o,-1);
  }
}
function draw(){
  scale=zoom*.46*Math.min(W/scene.extent[0],H2/scene.extent[1]);
  pixels.fill(0xffffffff);depth.fill(-Infinity);owner.fill(-1);
  const n=P.length/3;
  if(S.length!==3*n)S=new Float64Array(3*n);
  for(let i=0;i<n;++i){const p=project(P[3*i],P[3*i+1],P[3*i+2]);S[3*i]=p[0];S[3*i+1]=p[1];S[3*i+2]=p[2]}
  const light=unit([0,1,2].map(k=>-.35*right[k]+.5*up[k]+.8*eye[k]));
  for(let q=0;q<Q.length/4;++q){
    const a=Q[4*q],b=Q[4*q+1],c=Q[4*q+2],d=Q[4*q+3],at=i=>[P[3*i],P[3*i+1],P[3*i+2]];
    const m=(x,y)=>at(x).map((v,k)=>v-P[3*y+k]);
    let normal=unit(cross(m(c,a),m(d,b)));
    if(dot(normal,eye)<0)normal=normal.map(x=>-x);
    const shade=.68+.32*Math.max(0,dot(normal,light));
    const s=i=>[S[3*i]-S[3*a],S[3*i+1]-S[3*a+1]],e=s(b),f=s(c),g=s(d);
    const area=(Math.abs(e[0]*f[1]-e[1]*f[0])+Math.abs(f[0]*g[1]-f[1]*g[0]))/2;
    const strength=Math.max(0,Math.min(1,(Math.sqrt(area)-2)/6));
    triangle(a,b,c,3,strength,shade,q);triangle(a,c,d,6,strength,shade,q);
  }
  for(const top of [0,1])for(let i=0;i<L.length;i+=11)if(L[i+10]===top)line(i);
  pen.putImageData(image,0,0);
}
function turn(a,b,angle){
  const c=Math.cos(angle),s=Math.sin(angle);
  return [unit(a.map((x,k)=>c*x+s*b[k])),unit(b.map((x,k)=>c*x-s*a[k]))];
}
let waiting=false;
function later(){if(!waiting){waiting=true;requestAnimationFrame(()=>{waiting=false;draw()})}}
let held=null,moved=0;
const tip=document.getElementById("tip");
canvas.addEventListener("pointerdown",e=>{held=e;moved=0;canvas.setPointerCapture(e.pointerId);tip.style.display="none"});
canvas.addEventListener("pointermove",e=>{
  if(!held)return;
  const dx=e.clientX-held.clientX,dy=e.clientY-held.clientY,r=W/window.innerWidth;
  moved+=Math.abs(dx)+Math.abs(dy);
  if(e.shiftKey||e.buttons&2){shiftX+=dx*r;shiftY+=dy*r}
  else{[right,eye]=turn(right,eye,dx*.008);[up,eye]=turn(up,eye,-dy*.008);right=unit(cross(up,eye))}
  held=e;later();
});
canvas.addEventListener("pointerup",e=>{
  held=null;
  if(moved>3)return;
  const r=W/window.innerWidth,q=owner[Math.floor(e.clientY*r)*W+Math.floor(e.clientX*r)];
  if(q===undefined||q<0){tip.style.display="none";return}
  tip.textContent="hex "+H[q]+(scene.metric?", "+scene.metric+" "+V[q].toPrecision(4):"");
  tip.style.left=e.clientX+12+"px";tip.style.top=e.clientY+12+"px";tip.style.display="block";
});
canvas.addEventListener("wheel",e=>{
  e.preventDefault();
  const f=Math.exp(-e.deltaY*.0015),r=W/window.innerWidth,x=e.clientX*r-W/2,y=e.clientY*r-H2/2;
  shiftX=x+(shiftX-x)*f;shiftY=y+(shiftY-y)*f;zoom*=f;later();
},{passive:false});
canvas.addEventListener("contextmenu",e=>e.preventDefault());
canvas.addEventListener("dblclick",()=>{reset();later()});
window.addEventListener("resize",resize);
const key=document.getElementById("key"),add=(tag,text,to)=>{const e=document.createElement(tag);e.textContent=text;to.appendChild(e);return e};
add("b",scene.title,key);
if(scene.metric){
  const row=add("div","",key),bar=add("span","",row);
  bar.id="bar";bar.style.background="linear-gradient("+scene.scale.join(",")+")";
  add("span",scene.metric+": from "+scene.top+" (top) to "+scene.bottom+" (bottom)",row);
}
for(const [colour,text] of scene.legend){const row=add("div","",key);add("i","",row).style.background=colour;add("span",text,row)}
reset();resize();
</script></body></html>
)html";

template <class T>
std::string base64(const std::vector<T>& values) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  const std::size_t n = values.size() * sizeof(T);
  std::string result;
  result.reserve(n / 3 * 4 + 4);
  for (std::size_t i = 0; i < n; i += 3) {
    const unsigned a = bytes[i], b = i + 1 < n ? bytes[i + 1] : 0u, c = i + 2 < n ? bytes[i + 2] : 0u;
    result += digits[a >> 2];
    result += digits[(a & 3) << 4 | b >> 4];
    result += i + 1 < n ? digits[(b & 15) << 2 | c >> 6] : '=';
    result += i + 2 < n ? digits[c & 63] : '=';
  }
  return result;
}

/// As a string of JavaScript that may stand in a page.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    std::array<char, 8> code;
    if (static_cast<unsigned char>(c) < 0x20 || c == '"' || c == '\\' || c == '<' || c == '>' || c == '&') {
      std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(static_cast<unsigned char>(c)));
      result += code.data();
    } else {
      result += c;
    }
  }
  return result + "\"";
}
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return result;
}

std::string hex_text(const Colour& colour) {
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", static_cast<unsigned>(colour[0]),
                static_cast<unsigned>(colour[1]), static_cast<unsigned>(colour[2]));
  return text.data();
}
std::string number(double value) {
  return short_number(value, 9);
}
std::string triple(const Vec3& v) {
  return "[" + number(v.x()) + "," + number(v.y()) + "," + number(v.z()) + "]";
}

}  // namespace

std::string html(const Picture& picture) {
  const Vec3 eye = picture.view.normalized();
  Vec3 right = picture.up.cross(eye);
  if (right.norm() < 1e-6) right = (std::abs(eye.x()) < 0.5 ? Vec3::UnitX() : Vec3::UnitY()).cross(eye);
  right.normalize();
  const Vec3 up = eye.cross(right);
  Box box;
  for (const Vec3& p : picture.points) box.add(p);
  for (const Picture::Line& line : picture.lines) box.add(line.from), box.add(line.to);
  const Vec3 middle = box.empty() ? Vec3(0, 0, 0) : Vec3((box.min + box.max) / 2);
  const double size = box.diagonal() > 0 ? box.diagonal() : 1;
  // In units of its size around the origin: single precision is enough for a screen then.
  double wide = 1e-9, high = 1e-9;
  const auto add = [&](std::vector<float>& to, const Vec3& p) {
    const Vec3 q = (p - middle) / size;
    wide = std::max(wide, std::abs(right.dot(q)));
    high = std::max(high, std::abs(up.dot(q)));
    for (int k = 0; k < 3; ++k) to.push_back(static_cast<float>(q[k]));
  };
  std::vector<float> points, values, lines;
  std::vector<std::uint32_t> quads;
  std::vector<std::uint8_t> colours;
  std::vector<double> hexes;
  for (const Vec3& p : picture.points) add(points, p);
  for (const Picture::Facet& facet : picture.facets) {
    for (const std::int32_t corner : facet.corners) quads.push_back(static_cast<std::uint32_t>(corner));
    colours.insert(colours.end(), facet.colour.begin(), facet.colour.end());
    hexes.push_back(static_cast<double>(facet.hex));
    values.push_back(static_cast<float>(facet.value));
  }
  for (const Picture::Line& line : picture.lines) {
    add(lines, line.from);
    add(lines, line.to);
    lines.push_back(line.width);
    for (const std::uint8_t part : line.colour) lines.push_back(part);
    lines.push_back(line.on_top ? 1 : 0);
  }
  std::string page = page_head;
  const std::string mark = "%TITLE%";
  page.replace(page.find(mark), mark.size(), escaped(picture.title));
  page += "{title:" + quoted(picture.title) + ",metric:" + quoted(picture.metric);
  const double good = picture.small_is_better ? picture.low : picture.high;
  page += ",top:" + quoted(number(good)) + ",bottom:" + quoted(number(picture.low + picture.high - good));
  page += ",scale:[";
  for (int i = 10; i >= 0; --i) page += quoted(hex_text(scale_colour(i / 10.0))) + (i > 0 ? "," : "");
  page += "],legend:[";
  for (std::size_t i = 0; i < picture.legend.size(); ++i)
    page +=
        (i > 0 ? ",[" : "[") + quoted(hex_text(picture.legend[i].colour)) + "," + quoted(picture.legend[i].text) + "]";
  page += "],right:" + triple(right) + ",up:" + triple(up) + ",eye:" + triple(eye);
  page += ",extent:[" + number(wide) + "," + number(high) + "]";
  page += ",points:\"" + base64(points) + "\",quads:\"" + base64(quads) + "\",colours:\"" + base64(colours);
  page += "\",hexes:\"" + base64(hexes) + "\",values:\"" + base64(values) + "\",lines:\"" + base64(lines) + "\"}";
  return page + page_tail;
}

}  // namespace hextwist
